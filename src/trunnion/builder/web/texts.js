// Every word that the page shows, in each of its languages. A language that lacks a text shows the English one.

/** @type {Record<string, Record<string, string>>} */
const WORDS = {
  en: {
    add: "Start", base: "A machine to start from", begin: "A new definition", change: "Changes to a shipped machine", chain: "A chain of its own",
    choose: "Sample program from a CL file", clean: "no mistakes", control: "Control", definition: "Definition", down: "One place towards the tool",
    exists: "There is a file of this name already.", changed: "The file has been changed by someone else since it was opened.",
    cannot: "It cannot be saved.", name: "The name must end in .toml, name no folder and have none of < > : \" / \\ | ? *.", from: "From {0}", home: "To home", jog: "Jog",
    lost: "The page has lost its server: start trunnion build again.", many: "the CL file has more than 4 MB", mistake: "1 mistake", mistakes: "{0} mistakes",
    moved: "{0} lines new, {1} gone", myName: "Name of the machine", notStated: "not stated", order: "Order of the axes, from the workpiece to the tool",
    fixed: "The order is that of the machine that this one extends.", own: "changed here", passed: "Passed: {0} of {1} checks", inPart: "Passed in part: {0} of {1} checks", notChecked: "not checked", warnings: "warnings: {0}", notMeasured: "stands on {0} values nobody measured", assumed: "assumed: the control starts with {0}", program: "Sample program",
    refused: "The sample is refused", replace: "Replace it", lowest: "lowest", highest: "highest", reset: "Take the value of {0}", sampleFile: "shipped sample", save: "Save", saveAs: "Save as",
    saved: "Saved as {0}", savedBad: "Saved as {0}, with mistakes ({1}): no command takes it so", sections: "Pages", shown: "the first {0} of {1} lines are shown",
    stage: "Machine", start: "New …", tip: "Tip", toolAxis: "Tool axis", unclear: "This can only be changed in the text: the file writes it in a way of its own.",
    broken: "The text cannot be read: correct its mistakes first.", rejected: "This was not taken (the server answers {0}).",
    checked: "What each check has seen", toEnter: "{0} values still to be entered or measured",
    replaced: "The definition of this page has not been saved; a new one takes its place.",
    unsaved: "not saved", up: "One place towards the workpiece", waiting: "The sample waits until there are no mistakes.",
    zero: "without a workpiece zero, tip in the frame of the machine", failed: "the proof fails", cancel: "Cancel",
    structure: "Structure", travels: "Travels", rotary: "Rotary axes", spindle: "Spindle and zero", homePage: "Home and retracts", controlPage: "Control",
    formats: "Formats", head: "Program head", tool_change: "Tool change", operation: "Operations", foot: "Program foot", codes: "Coolant and M codes",
    cycles: "Cycles", smoothing: "Smoothing",
  },
  de: {
    add: "Beginnen", base: "Ausgangsmaschine", begin: "Neue Definition", change: "Änderungen an einer mitgelieferten Maschine", chain: "Eigene Achskette",
    choose: "Beispielprogramm aus CL-Datei", clean: "keine Fehler", control: "Steuerung", definition: "Definition", down: "Einen Platz zum Werkzeug hin",
    exists: "Eine Datei dieses Namens gibt es schon.", changed: "Die Datei wurde seit dem Öffnen von anderer Seite geändert.", cannot: "Speichern ist nicht möglich.",
    name: "Der Name muss auf .toml enden, keinen Ordner nennen und keines von < > : \" / \\ | ? * enthalten.", from: "Aus {0}", home: "Grundstellung", jog: "Verfahren",
    lost: "Der Server antwortet nicht mehr: trunnion build neu starten.", many: "die CL-Datei hat mehr als 4 MB", mistake: "1 Fehler", mistakes: "{0} Fehler", moved: "{0} Zeilen neu, {1} entfallen",
    myName: "Name der Maschine", notStated: "nicht angegeben", order: "Reihenfolge der Achsen, vom Werkstück zum Werkzeug", fixed: "Die Reihenfolge ist die der Ausgangsmaschine.",
    own: "hier geändert", passed: "Bestanden: {0} von {1} Prüfungen", inPart: "Teilweise bestanden: {0} von {1} Prüfungen", notChecked: "nicht geprüft", warnings: "Warnungen: {0}", notMeasured: "beruht auf {0} Werten, die niemand gemessen hat", assumed: "angenommen: die Steuerung beginnt mit {0}", program: "Beispielprogramm", refused: "Das Beispiel wird abgelehnt", replace: "Ersetzen",
    lowest: "kleinster", highest: "größter", reset: "Wert von {0} übernehmen", sampleFile: "mitgeliefertes Beispiel", save: "Speichern", saveAs: "Speichern als", saved: "Gespeichert als {0}",
    savedBad: "Gespeichert als {0}, mit {1} Fehlern: so nimmt sie kein Befehl an", sections: "Seiten", shown: "die ersten {0} von {1} Zeilen", stage: "Maschine", start: "Neu …",
    tip: "Spitze", toolAxis: "Werkzeugachse", unclear: "Das lässt sich nur im Text ändern: die Datei schreibt es auf eigene Art.",
    broken: "Der Text ist nicht lesbar: zuerst seine Fehler beheben.", rejected: "Das wurde nicht angenommen (der Server antwortet {0}).",
    checked: "Was jede Prüfung gesehen hat", toEnter: "{0} Werte noch einzutragen oder zu messen",
    replaced: "Die Definition dieser Seite ist nicht gespeichert; eine neue tritt an ihre Stelle.",
    unsaved: "nicht gespeichert", up: "Einen Platz zum Werkstück hin", waiting: "Das Beispiel wartet, bis keine Fehler mehr da sind.",
    zero: "ohne Werkstücknullpunkt: Spitze im Maschinensystem", failed: "der Beweis schlägt fehl", cancel: "Abbrechen",
    structure: "Aufbau", travels: "Verfahrwege", rotary: "Rundachsen", spindle: "Spindel und Nullpunkt", homePage: "Grundstellung und Rückzug", controlPage: "Steuerung",
    formats: "Formate", head: "Programmkopf", tool_change: "Werkzeugwechsel", operation: "Operationen", foot: "Programmende", codes: "Kühlmittel und M-Funktionen",
    cycles: "Zyklen", smoothing: "Glättung",
  },
  zh: {
    add: "开始", base: "起始机床", begin: "新定义", change: "修改自带的机床", chain: "自己的轴链", choose: "用 CL 文件生成样例程序", clean: "没有错误", control: "数控系统",
    definition: "定义", down: "向刀具移一位", exists: "同名文件已存在。", changed: "文件打开后已被他人修改。", cannot: "无法保存。", name: "文件名须以 .toml 结尾，不能包含文件夹或 < > : \" / \\ | ? *。",
    from: "来自 {0}", home: "回零位", jog: "点动", lost: "服务器没有响应：请重新运行 trunnion build。", many: "CL 文件超过 4 MB", mistake: "1 个错误", mistakes: "{0} 个错误", moved: "新增 {0} 行，删除 {1} 行",
    myName: "机床名称", notStated: "未给出", order: "轴的顺序，从工件到刀具", fixed: "顺序与起始机床相同。", own: "此处已修改", passed: "通过：{1} 项检查中的 {0} 项", inPart: "部分通过：{1} 项检查中的 {0} 项", notChecked: "未检查", warnings: "警告：{0}", notMeasured: "依赖 {0} 个无人测量过的值", assumed: "假定：控制系统启动时为 {0}", program: "样例程序",
    refused: "样例被拒绝", replace: "替换", lowest: "最小", highest: "最大", reset: "采用 {0} 的值", sampleFile: "自带样例", save: "保存", saveAs: "另存为", saved: "已保存为 {0}",
    savedBad: "已保存为 {0}，有 {1} 个错误：任何命令都不会接受", sections: "页面", shown: "显示前 {0} 行，共 {1} 行", stage: "机床", start: "新建…", tip: "刀尖", toolAxis: "刀轴",
    unclear: "只能在文本中修改：文件用了自己的写法。", broken: "文本无法读取：请先改正其中的错误。", rejected: "未被接受（服务器应答 {0}）。", checked: "各项检查的结果", toEnter: "还有 {0} 个值需要填写或测量", replaced: "此页面的定义尚未保存，将被新定义取代。", unsaved: "未保存", up: "向工件移一位", waiting: "没有错误后才生成样例。",
    zero: "没有工件零点：刀尖在机床坐标系中", failed: "验证失败", cancel: "取消",
    structure: "结构", travels: "行程", rotary: "旋转轴", spindle: "主轴与零点", homePage: "参考位置与退刀", controlPage: "数控系统", formats: "格式", head: "程序头",
    tool_change: "换刀", operation: "工序", foot: "程序尾", codes: "冷却与 M 代码", cycles: "循环", smoothing: "平滑",
  },
};

/**
 * Name and help of each field, by its key.
 * @type {Record<string, Record<string, string[]>>}
 */
const FIELDS = {
  "name": { en: ["Name", "What the machine is called."], de: ["Name", "Wie die Maschine heißt."], zh: ["名称", "机床的名称。"] },
  "description": { en: ["Description", "One sentence about it."], de: ["Beschreibung", "Ein Satz dazu."], zh: ["说明", "一句话。"] },
  "axis.kind": { en: ["Kind", "Moves along a line, or turns."], de: ["Art", "Linear- oder Rundachse."], zh: ["类型", "直线或旋转。"] },
  "axis.carries": { en: ["Carries", "The side that it moves: part or tool."], de: ["Trägt", "Was sie bewegt: Werkstück (part) oder Werkzeug (tool)."], zh: ["承载", "移动工件 (part) 还是刀具 (tool)。"] },
  "axis.direction": { en: ["Direction", "Along the linear axis, or along the line of rotation, all axes at zero; any length. Growing values move the tool, seen from the workpiece, along it or right-handed about it."], de: ["Richtung", "Entlang der Führung oder der Drehachse, alle Achsen auf null; Länge beliebig. Wachsende Werte bewegen das Werkzeug, vom Werkstück gesehen, in diese Richtung oder rechtshändig um sie."], zh: ["方向", "各轴在零位时沿导轨或旋转轴线的方向，长度任意。数值增大时，从工件看刀具沿此方向移动或绕其右手旋转。"] },
  "axis.positive": { en: ["Positive sense", "As ISO 841, or reversed."], de: ["Positiver Sinn", "Nach ISO 841 (standard) oder umgekehrt (reversed)."], zh: ["正方向", "按 ISO 841 (standard) 或相反 (reversed)。"] },
  "axis.limits_mm": { en: ["Travel", "Lowest and highest displayed value. Left empty, travel is not checked."], de: ["Verfahrweg", "Kleinster und größter angezeigter Wert. Leer: der Weg wird nicht geprüft."], zh: ["行程", "显示值的下限和上限。留空则不检查。"] },
  "axis.limits_deg": { en: ["Limits", "Lowest and highest displayed angle; none for an endless axis."], de: ["Grenzen", "Kleinster und größter angezeigter Winkel; keine bei endloser Achse."], zh: ["极限", "显示角度的下限和上限；无限回转轴不填。"] },
  "axis.rapid_mm_min": { en: ["Rapid", "Rapid traverse."], de: ["Eilgang", "Eilganggeschwindigkeit."], zh: ["快移", "快速移动速度。"] },
  "axis.rapid_deg_min": { en: ["Fastest turning", "1 rev/min is 360 °/min."], de: ["Größte Drehgeschwindigkeit", "1 U/min sind 360 °/min."], zh: ["最高转速", "1 转/分 = 360 °/min。"] },
  "axis.acceleration_mm_s2": { en: ["Acceleration", "1 m/s² is 1000 mm/s²."], de: ["Beschleunigung", "1 m/s² sind 1000 mm/s²."], zh: ["加速度", "1 m/s² = 1000 mm/s²。"] },
  "axis.acceleration_deg_s2": { en: ["Acceleration", ""], de: ["Beschleunigung", ""], zh: ["加速度", ""] },
  "axis.jerk_mm_s3": { en: ["Jerk", "How fast the acceleration changes. Left empty, times count none."], de: ["Ruck", "Wie schnell sich die Beschleunigung ändert. Leer: Zeiten rechnen ohne."], zh: ["加加速度", "加速度变化的快慢。留空则时间计算不考虑。"] },
  "axis.jerk_deg_s3": { en: ["Jerk", "As for linear axes."], de: ["Ruck", "Wie bei Linearachsen."], zh: ["加加速度", "同直线轴。"] },
  "axis.point_mm": { en: ["Centre", "A point on the line of rotation, any one, in the machine frame with all axes at zero. Measure it: an error here is an error of the part without TCP."], de: ["Drehpunkt", "Irgendein Punkt der Drehachse im Maschinensystem, alle Achsen auf null. Zu messen: ohne TCP ist ein Fehler hier ein Fehler am Teil."], zh: ["回转中心", "各轴在零位时旋转轴线上的任一点（机床坐标系）。必须测量：没有 TCP 时此处的误差就是零件的误差。"] },
  "axis.endless": { en: ["Endless", "Turns without end; then there are no limits."], de: ["Endlos", "Dreht ohne Ende; dann gibt es keine Grenzen."], zh: ["无限回转", "可以无限旋转，没有极限。"] },
  "axis.output": { en: ["Written as", "Of an endless axis: fold values into one turn, or write them as they wind."], de: ["Ausgabe", "Endlose Achse: Werte in eine Umdrehung falten oder weiterzählen."], zh: ["输出", "无限回转轴：折算到一圈内，或连续累加。"] },
  "axis.prefer": { en: ["Usual sign", "Sign of the axis in the machine's usual pose: cuts begin in it where that needs no more rewinds."], de: ["Übliches Vorzeichen", "Vorzeichen in der üblichen Stellung: Schnitte beginnen darin, wo das nicht mehr Rückdrehungen kostet."], zh: ["常用符号", "机床常用姿态中该轴的符号。"] },
  "axis.home_mm": { en: ["Home", "Home position, inside the limits. Programs that go there warn if it is not stated."], de: ["Grundstellung", "Innerhalb der Grenzen. Programme, die sie anfahren, warnen, wenn sie nicht angegeben ist."], zh: ["参考位置", "在极限之内。未给出时程序会警告。"] },
  "axis.home_deg": { en: ["Home", "Home position, inside the limits."], de: ["Grundstellung", "Innerhalb der Grenzen."], zh: ["参考位置", "在极限之内。"] },
  "spindle.direction": { en: ["Spindle direction", "From the tool tip to the holder, all axes at zero."], de: ["Spindelrichtung", "Von der Spitze zum Halter, alle Achsen auf null."], zh: ["主轴方向", "各轴在零位时从刀尖指向刀柄。"] },
  "spindle.gauge_point_mm": { en: ["Gauge point", "Where tool lengths are measured from, all axes at zero. From it to the centre of a head's last rotary axis is the pivot length."], de: ["Bezugspunkt", "Von dem Werkzeuglängen gemessen werden, alle Achsen auf null. Bis zum Drehpunkt der letzten Rundachse eines Kopfes ist es die Pivotlänge."], zh: ["基准点", "刀长的测量起点（各轴在零位）。到摆头最后旋转轴中心的距离即摆长。"] },
  "workpiece.zero_mm": { en: ["Workpiece zero", "In the machine frame, all axes at zero. Programs with TCP do not need it; linear axes are checked against their limits with it."], de: ["Werkstücknullpunkt", "Im Maschinensystem, alle Achsen auf null. Mit TCP nicht nötig; mit ihm werden die Linearachsen gegen ihre Grenzen geprüft."], zh: ["工件零点", "各轴在零位时的机床坐标。使用 TCP 的程序不需要；给出后会检查直线轴行程。"] },
  "spindle.min_rpm": { en: ["Lowest speed", "A lower one is refused."], de: ["Kleinste Drehzahl", "Eine kleinere wird abgelehnt."], zh: ["最低转速", "更低的被拒绝。"] },
  "spindle.max_rpm": { en: ["Highest speed", "A higher one is refused."], de: ["Größte Drehzahl", "Eine größere wird abgelehnt."], zh: ["最高转速", "更高的被拒绝。"] },
  "spindle.acceleration_rpm_s": { en: ["Speeding up", "Change of the speed in a second, for times. Left empty, it takes no time."], de: ["Hochlauf", "Änderung der Drehzahl in einer Sekunde, für Zeiten. Leer: er dauert nicht."], zh: ["主轴加速", "每秒转速变化，用于时间计算。留空则不计时。"] },
  "spindle.tool_change_s": { en: ["Tool change", "Seconds from the stop to the next motion, for times. Left empty, it takes no time."], de: ["Werkzeugwechsel", "Sekunden vom Halt bis zur nächsten Bewegung, für Zeiten. Leer: er dauert nicht."], zh: ["换刀", "从停止到下一次运动的秒数，用于时间计算。留空则不计时。"] },
  "spindle.power_kw": { en: ["Power", "Nothing is compared with it."], de: ["Leistung", "Wird mit nichts verglichen."], zh: ["功率", "不参与检查。"] },
  "spindle.torque_nm": { en: ["Torque", "Nothing is compared with it."], de: ["Drehmoment", "Wird mit nichts verglichen."], zh: ["扭矩", "不参与检查。"] },
  "control.extends": { en: ["Control", "The shipped control that is nearest; what is different follows."], de: ["Steuerung", "Die ähnlichste mitgelieferte Steuerung; Abweichungen folgen."], zh: ["数控系统", "最接近的自带系统；差异在后面填写。"] },
  "control.extension": { en: ["File extension", "Of program files, such as .mpf."], de: ["Dateiendung", "Der Programme, etwa .mpf."], zh: ["扩展名", "程序文件的扩展名，如 .mpf。"] },
  "control.tcp": { en: ["Has TCP", "The control can hold the tip while rotary axes turn (TRAORI, G43.4, M128)."], de: ["TCP vorhanden", "Die Steuerung hält die Spitze, während Rundachsen drehen (TRAORI, G43.4, M128)."], zh: ["有 TCP", "旋转轴转动时系统能保持刀尖 (TRAORI, G43.4, M128)。"] },
  "control.plane_from_pose": { en: ["Plane from the pose", "A tilted plane is taken from the rotary position."], de: ["Ebene aus der Stellung", "Eine geschwenkte Ebene folgt aus der Stellung der Rundachsen."], zh: ["由姿态定平面", "倾斜平面取自旋转轴的位置。"] },
  "control.shorter_way": { en: ["Shorter way", "Endless axes take the shorter way."], de: ["Kürzerer Weg", "Endlose Achsen nehmen den kürzeren Weg."], zh: ["走近路", "无限回转轴走较短的一边。"] },
  "control.own_blocks": { en: ["Own blocks", "Spindle, coolant and radius compensation have blocks of their own."], de: ["Eigene Sätze", "Spindel, Kühlmittel und Radiuskorrektur stehen in eigenen Sätzen."], zh: ["单独程序段", "主轴、冷却和刀补各占一段。"] },
  "control.stops_in_compensation": { en: ["Stops in compensation", "M0 and M1 may stand within radius compensation."], de: ["Halte in der Korrektur", "M0 und M1 dürfen in der Radiuskorrektur stehen."], zh: ["刀补中停止", "刀补中允许 M0 和 M1。"] },
  "control.radius_as_diameter": { en: ["Radius entered as diameter", "always, or a condition such as: setting 40 is DIAMETER. Empty: never."], de: ["Radius als Durchmesser", "always (immer) oder eine Bedingung wie: setting 40 is DIAMETER. Leer: nie."], zh: ["半径按直径输入", "always（始终），或条件，例如 setting 40 is DIAMETER；空：从不。"] },
  "control.threads_stop_spindle": { en: ["Threads stop the spindle", "The spindle stands after a thread."], de: ["Gewinde hält die Spindel an", "Nach einem Gewinde steht die Spindel."], zh: ["攻丝后停主轴", "攻丝后主轴停止。"] },
  "control.level_approach": { en: ["Level approach", "X and Y first, then Z, in three-axis operations too."], de: ["Ebene Anfahrt", "Erst X und Y, dann Z, auch dreiachsig."], zh: ["先平面后 Z", "三轴工序也先走 X、Y 再走 Z。"] },
  "control.rapid_into_planes": { en: ["Rapid into planes", "The first motion in a new tilted plane must be a rapid."], de: ["Eilgang in Ebenen", "Die erste Bewegung in einer neuen Ebene muss Eilgang sein."], zh: ["快移进入平面", "新倾斜平面中的首个运动必须是快移。"] },
  "control.plane_x": { en: ["X of a plane", "As the CL file turns it, or that of the machine after the rotation."], de: ["X einer Ebene", "Wie die CL-Datei es dreht (program) oder das der Maschine (machine)."], zh: ["平面的 X", "按 CL 文件 (program) 或机床 (machine)。"] },
  "control.feed_without_tcp": { en: ["F without TCP", "What F counts while rotary axes turn."], de: ["F ohne TCP", "Was F zählt, während Rundachsen drehen."], zh: ["无 TCP 时的 F", "旋转轴转动时 F 的含义。"] },
  "control.blocks_in_compensation": { en: ["Blocks in compensation", "Most blocks in a row without motion in the plane within radius compensation; 9999: no limit."], de: ["Sätze in der Korrektur", "So viele Sätze ohne Bewegung in der Ebene dürfen aufeinander folgen; 9999: beliebig viele."], zh: ["刀补中的程序段", "刀补中允许的连续非平面运动段数；9999 为不限。"] },
  "control.holes_from": { en: ["To the next hole", "The height at which a cycle goes to the next hole."], de: ["Zum nächsten Loch", "Höhe, auf der ein Zyklus zum nächsten Loch fährt."], zh: ["到下一孔", "循环移到下一孔的高度。"] },
  "control.block_numbers.numbered": { en: ["Block numbers", "Whether blocks have numbers."], de: ["Satznummern", "Ob Sätze Nummern haben."], zh: ["程序段号", "是否写段号。"] },
  "control.block_numbers.letter": { en: ["Letter", "Before the number."], de: ["Buchstabe", "Vor der Nummer."], zh: ["字母", "段号前的字母。"] },
  "control.block_numbers.start": { en: ["First number", ""], de: ["Erste Nummer", ""], zh: ["起始号", ""] },
  "control.block_numbers.step": { en: ["Step", ""], de: ["Schritt", ""], zh: ["增量", ""] },
  "control.block_numbers.highest": { en: ["Highest number", "The count begins again after it."], de: ["Höchste Nummer", "Danach wird von vorn gezählt."], zh: ["最大号", "之后重新计数。"] },
  "control.format.decimals": { en: ["Decimals", ""], de: ["Nachkommastellen", ""], zh: ["小数位", ""] },
  "control.format.decimals_three_axis": { en: ["Decimals, three axes", "In three-axis operations; empty: the same."], de: ["Nachkommastellen dreiachsig", "In dreiachsigen Operationen; leer: gleich viele."], zh: ["三轴小数位", "三轴工序；空则相同。"] },
  "control.format.point": { en: ["Point after whole numbers", "5. and not 5"], de: ["Punkt nach ganzen Zahlen", "5. statt 5"], zh: ["整数带小数点", "5. 而非 5"] },
  "control.format.leading_zero": { en: ["Leading zero", "0.5 and not .5"], de: ["Führende Null", "0.5 statt .5"], zh: ["前导零", "0.5 而非 .5"] },
  "control.format.trailing_zeros": { en: ["Trailing zeros", "1.500 and not 1.5"], de: ["Nachfolgende Nullen", "1.500 statt 1.5"], zh: ["尾随零", "1.500 而非 1.5"] },
  "control.format.plus": { en: ["Plus sign", "+5 and not 5"], de: ["Pluszeichen", "+5 statt 5"], zh: ["正号", "+5 而非 5"] },
  "control.format.zero": { en: ["Zero is written as", "Empty: as other numbers."], de: ["Null heißt", "Leer: wie andere Zahlen."], zh: ["零写作", "空：与其他数相同。"] },
  "control.between_points.axis_tolerance_deg": { en: ["Tool axis between points", "How far it may leave its path."], de: ["Werkzeugachse zwischen Punkten", "Wie weit sie von ihrem Weg abweichen darf."], zh: ["点间刀轴偏差", "允许偏离路径的角度。"] },
  "control.between_points.finishing_axis_tolerance_deg": { en: ["The same in finishing", ""], de: ["Dasselbe beim Schlichten", ""], zh: ["精加工时", ""] },
  "control.arcs.chord_tolerance": { en: ["Chord tolerance", "Greatest distance of the lines that an arc becomes where it cannot stay one."], de: ["Sehnentoleranz", "Größter Abstand der Geraden, zu denen ein Bogen wird, der keiner bleiben kann."], zh: ["弦差", "圆弧改为直线时的最大偏差。"] },
  "control.arcs.about": { en: ["Arcs about", "The axes about which circles are written."], de: ["Bögen um", "Achsen, um die Kreise geschrieben werden."], zh: ["圆弧绕", "可写圆弧的轴。"] },
  "control.arcs.by": { en: ["Arcs by", "Centre or radius."], de: ["Bögen mit", "Mittelpunkt (centre) oder Radius (radius)."], zh: ["圆弧写法", "圆心 (centre) 或半径 (radius)。"] },
  "control.arcs.helices": { en: ["Helices", "The control has them."], de: ["Schraubenlinien", "Die Steuerung kann sie."], zh: ["螺旋线", "系统支持。"] },
  "control.arcs.turns": { en: ["Several turns", "In one block."], de: ["Mehrere Umdrehungen", "In einem Satz."], zh: ["多圈", "在一段中。"] },
  "control.templates": { en: ["", "The text as the program has it, with {field} where a value stands; a change at one place changes no other."], de: ["", "Der Text, wie ihn das Programm hat, mit {feld}, wo ein Wert steht."], zh: ["", "程序中的文本，{字段} 处为数值。"] },
  "control.coolant": { en: ["", "M code of this coolant."], de: ["", "M-Funktion dieses Kühlmittels."], zh: ["", "此冷却方式的 M 代码。"] },
  "control.codes": { en: ["", "Number of this G or M word."], de: ["", "Nummer dieses G- oder M-Wortes."], zh: ["", "此 G 或 M 字的编号。"] },
  "control.known": { en: ["", "What this word of the machine's builder does."], de: ["", "Was dieses Wort des Maschinenherstellers bewirkt."], zh: ["", "机床厂的此字的作用。"] },
  "control.settings": { en: ["", ""] },
};

const WANTED = (new URLSearchParams(location.search).get("lang") ?? navigator.language).slice(0, 2);

/** The language of the page. */
export const LANGUAGE = WANTED in WORDS ? WANTED : "en";

/**
 * A text in the language of the browser, or of ?lang= in the address.
 * @param {string} key
 * @param {...(string | number)} values that stand for {0}, {1}
 */
export function say(key, ...values) {
  const text = WORDS[LANGUAGE]?.[key] ?? WORDS.en[key] ?? key;
  return values.reduce((/** @type {string} */ made, value, k) => made.replaceAll(`{${k}}`, String(value)), text);
}

/**
 * Name and help of a field.
 * @param {import("./form.js").FieldData} field
 * @returns {[string, string]}
 */
export function fieldTexts(field) {
  const last = /** @type {string} */ (field.path.at(-1));
  const group = FIELDS[field.key] ? field.key : field.key.slice(0, field.key.lastIndexOf("."));
  const [name, help] = FIELDS[group]?.[LANGUAGE] ?? FIELDS[group]?.en ?? ["", ""];
  const note = [field.note, field.allowed].filter(Boolean).join(" — ");
  return [name || last, help || note];
}
