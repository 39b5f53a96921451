// Every word that the page shows, in each of its languages. A language that lacks a text shows the English one.

/** @type {Record<string, Record<string, string>>} */
export const TEXTS = {
  en: {
    live: "live", liveGone: "The machine is not connected.",
    approach: "approach", cut: "cut", departure: "departure", engage: "engage", phase: "phase", retract: "retract", stepover: "step-over", traverse: "traverse",
    circle: "circle", straight: "line",
    apart: "The programs go together nowhere.", limits: "limits", rewind: "rewind",
    all: "whole part", axisValue: "limit", against: "Time", back: "previous", block: "Block", bodies: "machine", cl: "CL line",
    close: "Close", colour: "Colour by", copied: "Saved", csv: "Curves as CSV", deviation: "deviation", distance: "Distance", end: "Last block", feed: "feed",
    file: "File", finding: "finding", findings: "Findings", first: "First block", fixture: "fixture", frame: "Stand",
    frameMachine: "before the machine", framePart: "on the table", front: "From the front", gouge: "missing", help: "Keys", iso: "In space",
    kind: "kind of motion", left: "left", known: "The path is broken where the program moves to positions of the machine and no workpiece zero is known.",
    line: "Line", loading: "Loading …", measure: "Measure", next: "next", none: "off", operation: "operation", part: "part", pause: "Pause",
    path: "path", picture: "Screenshot", play: "Play", rapid: "Rapid", right: "From the right", rotary: "rotary speed",
    search: "Search in the program", section: "Section", speed: "Speed", stock: "Stock", stockAfter: "Stock after line {0}.",
    stockBetween: "Stock after line {0}; the next of the {2} states of this page is after line {1}.", stockCells: "Shown in cells of {0}.",
    stockCut: "as it is cut", stockCutting: "Cutting to line {0} …", stockEnds: "The program was simulated up to line {0}.",
    stockFinished: "The finished stock against the part.", stockUncut: "Stock before the first block.", step: "Next block", stepBack: "Previous block", tip: "Tip",
    tool: "tool", toolAxis: "Tool axis", toolChange: "tool change", toolForm: "The form of tool {0} is not known: it is drawn as a needle.",
    top: "From above", untimed: "No times are known: each block takes the same.", view: "View",
    zero: "No workpiece zero is known: the part is drawn at the machine's zero.", notFound: "Not found", measureHint: "Click two points of the path.",
  },
  de: {
    live: "live", liveGone: "Die Maschine ist nicht verbunden.",
    approach: "Anfahren", cut: "Schnitt", departure: "Abfahren", engage: "Eintauchen", phase: "Phase", retract: "Rückzug", stepover: "Zustellung", traverse: "Überfahren",
    circle: "Kreis", straight: "Gerade",
    apart: "Die Programme gehen nirgends gemeinsam.", limits: "Grenzen", rewind: "Rückdrehung",
    all: "ganzes Teil", against: "Zeit", back: "zurück", block: "Satz", bodies: "Maschine", cl: "CL-Zeile", close: "Schließen",
    colour: "Farbe nach", csv: "Kurven als CSV", deviation: "Abweichung", distance: "Abstand", end: "Letzter Satz", feed: "Vorschub", file: "Datei", finding: "Befund",
    findings: "Befunde", first: "Erster Satz", fixture: "Spannmittel", frame: "Standort", frameMachine: "vor der Maschine",
    framePart: "auf dem Tisch", front: "Von vorn", gouge: "fehlt", help: "Tasten", iso: "Räumlich", kind: "Bewegungsart", left: "übrig", line: "Zeile", loading: "Lädt …",
    known: "Die Bahn ist unterbrochen, wo das Programm Maschinenpositionen anfährt und kein Werkstücknullpunkt bekannt ist.",
    measure: "Messen", next: "weiter", none: "aus", operation: "Operation", part: "Teil", pause: "Pause", path: "Bahn", picture: "Bild sichern",
    play: "Abspielen", rapid: "Eilgang", right: "Von rechts", rotary: "Drehgeschwindigkeit", search: "Im Programm suchen", section: "Schnitt",
    stock: "Werkstück", stockAfter: "Werkstück nach Zeile {0}.", stockCells: "Gezeigt in Zellen von {0}.", stockCut: "wie bearbeitet",
    stockBetween: "Werkstück nach Zeile {0}; der nächste der {2} Zustände dieser Seite ist nach Zeile {1}.", stockCutting: "Wird bis Zeile {0} bearbeitet …",
    stockEnds: "Das Programm wurde bis Zeile {0} simuliert.", stockFinished: "Das fertige Werkstück gegen das Sollteil.", stockUncut: "Rohteil vor dem ersten Satz.",
    speed: "Tempo", step: "Nächster Satz", stepBack: "Voriger Satz", tip: "Spitze", tool: "Werkzeug", toolAxis: "Werkzeugachse",
    toolChange: "Werkzeugwechsel", toolForm: "Die Form von Werkzeug {0} ist nicht bekannt: es ist als Nadel gezeichnet.", top: "Von oben",
    untimed: "Zeiten sind nicht bekannt: jeder Satz dauert gleich lang.", view: "Ansicht", notFound: "Nicht gefunden",
    zero: "Der Werkstücknullpunkt ist nicht bekannt: das Teil ist im Maschinennullpunkt gezeichnet.", measureHint: "Zwei Punkte der Bahn anklicken.",
  },
  zh: {
    live: "实时", liveGone: "机床未连接。",
    approach: "接近", cut: "切削", departure: "离开", engage: "进刀", phase: "阶段", retract: "退刀", stepover: "步进", traverse: "移刀",
    circle: "圆弧", straight: "直线",
    apart: "两个程序没有共同的轨迹。", limits: "极限", rewind: "回转",
    all: "整个零件", against: "时间", back: "上一个", block: "程序段", bodies: "机床", cl: "CL 行", close: "关闭", colour: "着色", csv: "曲线导出 CSV",
    deviation: "偏差", gouge: "过切", left: "余量", stock: "毛坯", stockAfter: "第 {0} 行之后的毛坯。", stockCells: "显示单元 {0}。", stockCut: "切削状态",
    stockBetween: "第 {0} 行之后的毛坯；本页 {2} 个状态中的下一个在第 {1} 行之后。", stockCutting: "正在切削到第 {0} 行…",
    stockEnds: "程序已仿真到第 {0} 行。", stockFinished: "加工结果与零件模型的比较。", stockUncut: "第一段之前的毛坯。",
    distance: "距离", end: "最后一段", feed: "进给", file: "文件", finding: "问题", findings: "问题", first: "第一段", fixture: "夹具", frame: "视点",
    frameMachine: "机床前", framePart: "工作台上", front: "前视", help: "按键", iso: "立体", kind: "运动类型",
    known: "程序移动到机床坐标而工件零点未知时，轨迹中断。", line: "行", loading: "正在加载…", measure: "测量", next: "下一个", none: "关",
    operation: "工序", part: "零件", pause: "暂停", path: "轨迹", picture: "截图", play: "播放", rapid: "快移", right: "右视", rotary: "旋转速度",
    search: "在程序中查找", section: "剖切", speed: "速度", step: "下一段", stepBack: "上一段", tip: "刀尖", tool: "刀具", toolAxis: "刀轴",
    toolChange: "换刀", toolForm: "刀具 {0} 的形状未知：画成细针。", top: "俯视", untimed: "时间未知：每段时间相同。", view: "视图", notFound: "未找到",
    zero: "工件零点未知：零件画在机床零点。", measureHint: "点击轨迹上的两点。",
  },
};

const WANTED = (new URLSearchParams(location.search).get("lang") ?? navigator.language).slice(0, 2);

/** The language of the page. */
export const LANGUAGE = WANTED in TEXTS ? WANTED : "en";

/**
 * A text in the language of the browser, or of ?lang= in the address.
 * @param {string} key
 * @param {...(string | number)} values that stand for {0}, {1}
 */
export function say(key, ...values) {
  const text = TEXTS[LANGUAGE]?.[key] ?? TEXTS.en[key] ?? key;
  return values.reduce((/** @type {string} */ made, value, k) => made.replace(`{${k}}`, String(value)), text);
}
