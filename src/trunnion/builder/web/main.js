// The page: fields, text, machine and sample are four views of one definition, which the server judges at every change.

import { Editor } from "./editor.js";
import { Edits } from "./edits.js";
import { Form, covers, refill } from "./form.js";
import { Jog } from "./jog.js";
import { Sample } from "./sample.js";
import { Stage } from "./stage.js";
import { putTexts, say } from "../../viewer/web/texts.js";

/**
 * @param {string} id
 * @returns {any}
 */
const element = (id) => document.getElementById(id);

/** A CL file is not larger. */
const MOST_CL = 4_000_000;

/**
 * What a page is called; two have names that are other words of the page too.
 * @param {string} name
 */
const pageKey = (name) => /** @type {PlainKey} */ ({ home: "homePage", control: "controlPage" }[name] ?? name);

class Builder {
  /** @param {any} start */
  constructor(start) {
    this.start = start;
    this.file = start.file;
    this.seen = start.seen;
    this.saved = start.text;
    this.page = "structure";
    /** @type {any} */
    this.data = null;
    /** @type {{name: string, content: string} | null} */
    this.cl = null;
    this.unclear = "";
    this.isSaving = false;
    this.sampled = 0;
    this.stage = new Stage(element("space"));
    this.jogging = new Jog(element("jog"), element("pose"), this.stage);
    this.form = new Form(element("form"), (path, value, entered) => this.change({ path, value }, () => this.form.settle(path, entered)), (from) => this.editor.show(Number(from.split(":").at(-1))));
    /** @type {Editor} */
    this.editor = new Editor(element("text"), element("gutter"), () => { this.unclear = ""; this.edits.typed(); this.tell("", false); }, () => this.edits.rested());
    /** @type {Edits} */
    this.edits = new Edits({ text: () => this.editor.text, post: (what, given) => this.post(what, given), show: (answer, edit) => this.show(answer, edit) });
    this.sample = new Sample(element("program"), element("verdict"), element("checks"));
    this.#listen();
  }

  /**
   * Post to the server; null: it is gone. What it does not take has its status as "rejected".
   * @param {string} what
   * @param {any} given
   */
  async post(what, given) {
    try {
      const answer = await fetch(what, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ file: this.file, language: this.start.language, ...given }) });
      return answer.ok ? await answer.json() : { rejected: answer.status };
    } catch {
      this.tell(say("lost"), true);
      return null;
    }
  }

  /**
   * @param {any} given what is to be changed
   * @param {() => void} settle when it has had its answer
   */
  change(given, settle = () => {}) {
    if (this.edits.isIdle) this.unclear = "";
    this.edits.add({ what: "change", given, settle });
  }

  /**
   * Show an answer about the text of the page, which a change replaces.
   * @param {any} data
   * @param {import("./edits.js").Edit | undefined} edit
   */
  show(data, edit) {
    if (edit?.what === "begin") this.#beginsAnew();
    if (data.rejected) this.unclear = say("rejected", { status: data.rejected });
    if (data.unclear) this.unclear = say(data.unclear);
    if (!data.rejected) {
      this.data = data;
      this.editor.set(data.text);
    }
    if (this.data) this.#showData(this.data);
    this.tell(this.unclear, Boolean(this.unclear));
    if (!data.rejected && !this.edits.queue.length) this.runSample();
  }

  /** @param {any} data */
  #showData(data) {
    this.editor.mark(data.problems);
    this.#showPages();
    this.#showPage();
    this.#showProblems();
    if (data.machine) {
      this.stage.show(data.machine, data.bodies);
      this.jogging.show(data.remark);
    }
  }

  /** What was opened is another definition: it is not replaced unasked. */
  #beginsAnew() {
    if (!this.editor.text.trim()) return;
    this.seen = this.file = "";
    element("title").textContent = "machine.toml";
  }

  /**
   * The state of the file, or what has gone wrong.
   * @param {string} what
   * @param {boolean} bad
   */
  tell(what, bad) {
    element("state").textContent = what || (this.editor.text === this.saved ? "" : say("unsaved"));
    element("state").className = bad ? "bad" : "";
  }

  #showPages() {
    const { pages, problems } = this.data;
    refill(element("pages"), Object.keys(pages).map((name) => {
      const button = Object.assign(document.createElement("button"), { type: "button", textContent: say(pageKey(name)) });
      button.dataset.page = button.dataset.key = name;
      if (name === this.page) button.setAttribute("aria-current", "page");
      const wrong = problems.some((/** @type {any} */ each) => pages[name].some((/** @type {any} */ field) => covers(each.path, field.path)));
      if (wrong) { button.className = "bad"; button.textContent += " ⚠"; }
      button.addEventListener("click", () => this.goTo(name));
      return button;
    }));
  }

  /** @param {string} page */
  goTo(page) {
    this.form.sendAll();
    this.page = page;
    this.#showPages();
    this.#showPage();
    element("form").scrollTop = 0;
    element("pages").querySelector(`[data-page="${page}"]`)?.focus();
  }

  #showPage() {
    this.form.show(this.data.pages[this.page], this.data.problems, this.data.marks, this.page === "structure" ? this.#order() : null);
  }

  /** The axes in their order, with the means to change it. */
  #order() {
    const box = document.createElement("div");
    box.append(Object.assign(document.createElement("h3"), { textContent: say("order") }));
    const list = Object.assign(document.createElement("ol"), { className: "order" });
    this.data.axes.forEach((/** @type {string} */ name, /** @type {number} */ k) => {
      const item = Object.assign(document.createElement("li"), { textContent: name });
      if (!this.data.extends) {
        for (const [by, sign, words] of /** @type {[number, string, "up" | "down"][]} */ ([[-1, "◀", "up"], [1, "▶", "down"]])) {
          const button = Object.assign(document.createElement("button"), { type: "button", textContent: sign, title: `${name}: ${say(words)}` });
          button.dataset.key = `${name} ${by}`;
          button.disabled = by < 0 ? k === 0 : k === this.data.axes.length - 1;
          button.setAttribute("aria-label", button.title);
          button.addEventListener("click", () => this.change({ move: name, by }));
          item.append(button);
        }
      }
      list.append(item);
    });
    box.append(list);
    if (this.data.extends) box.append(Object.assign(document.createElement("p"), { className: "help", textContent: say("fixed") }));
    for (const jog of this.data.jogs) box.append(Object.assign(document.createElement("p"), { className: "help", textContent: `${jog.axis}: ${jog.what}` }));
    return box;
  }

  #showProblems() {
    const { problems, marks } = this.data;
    const found = problems.length ? say("mistakes", { count: problems.length }) : say("clean");
    element("mistakes").textContent = marks.length ? say("both", { mistakes: found, marks: say("toEnter", { count: marks.length }) }) : found;
    element("mistakes").className = problems.length ? "bad" : marks.length ? "warn" : "good";
    refill(element("problems"), [...problems, ...marks].map((/** @type {any} */ each) => {
      const item = Object.assign(document.createElement("li"), { className: each.code === undefined ? "warn" : "" });
      const where = each.line ? `${each.line}: ` : each.place ? `${each.place}: ` : "";
      const button = Object.assign(document.createElement("button"), { type: "button", textContent: `${where}${each.text}` });
      button.dataset.key = button.textContent ?? "";
      button.addEventListener("click", () => this.#goToProblem(each));
      item.append(button);
      return item;
    }));
  }

  /** @param {any} problem */
  #goToProblem(problem) {
    const page = Object.keys(this.data.pages).find((name) => this.data.pages[name].some((/** @type {any} */ field) => covers(problem.path, field.path)));
    if (page) { this.goTo(page); this.form.focus(problem.path); }
    if (problem.line) this.editor.show(problem.line);
  }

  /**
   * Move the machine.
   * @param {number[]} values
   */
  jog(values) { this.jogging.move(values); }

  /** Post and prove the sample again, unless there are mistakes. */
  async runSample() {
    element("cl-name").textContent = this.cl?.name ?? say("sampleFile");
    if (!this.data) return;
    const number = ++this.sampled;
    const { text } = this.data;
    if (this.data.problems.length) { this.sample.clear(say("waiting")); this.isSampled(); return; }
    element("program").dataset.ready = "false";
    const found = await this.post("sample", { text, cl: this.cl?.content ?? null, clName: this.cl?.name ?? "", before: this.sample.lines.slice(0, 3000) });
    if (number !== this.sampled) return;
    if (found && !found.rejected) this.sample.show(found, this.data.marks.length);
    else this.sample.clear(found ? say("rejected", { status: found.rejected }) : say("lost"));
    this.isSampled();
  }

  isSampled() { element("program").dataset.ready = "true"; }

  /** @param {boolean} replace */
  async save(replace) {
    if (this.isSaving) return;
    this.isSaving = true;
    await this.#save(replace);
    this.isSaving = false;
  }

  /** @param {boolean} replace */
  async #save(replace) {
    const name = element("save-name").value.trim();
    this.form.sendAll();
    const isSettled = await this.edits.settled();
    if (!isSettled || this.unclear) {
      element("save-why").textContent = isSettled ? this.unclear : say("lost");
      this.unclear = "";
      return;
    }
    const { text } = this.editor;
    const found = await this.post("save", { text, name, seen: this.seen, replace });
    if (!found?.saved) {
      const why = !found ? say("lost") : found.rejected ? say("rejected", { status: found.rejected }) : say(found.why);
      element("save-why").textContent = [why, ...(found?.problems ?? [])].join("\n");
      if (!found || found.rejected) return;
      element("save-replace").hidden = found.why !== "exists" && found.why !== "changed";
      return;
    }
    this.seen = found.seen;
    this.saved = text;
    this.file = element("title").textContent = found.name;
    const address = new URL(location.href);
    address.searchParams.set("file", found.name);
    history.replaceState(null, "", address);
    element("saving").close();
    this.tell(found.mistakes ? say("savedBad", { file: found.saved, count: found.mistakes }) : say("saved", { file: found.saved }), found.mistakes > 0);
  }

  begin() {
    const fill = (/** @type {string} */ id, /** @type {[string, string][]} */ options) => element(id).replaceChildren(...options.map(([value, text]) => new Option(text, value)));
    fill("begin-base", this.start.machines.map((/** @type {any} */ each) => [each.key, `${each.key}: ${each.name}`]));
    fill("begin-chain", this.start.chains.map((/** @type {any} */ each) => [each.key, each.order]));
    fill("begin-control", this.start.controls.map((/** @type {string} */ each) => [each, each]));
    element("begin-why").textContent = this.editor.text === this.saved ? "" : say("replaced");
    element("begin").showModal();
  }

  #listen() {
    element("title").textContent = this.start.title;
    element("start").addEventListener("click", () => this.begin());
    element("begin-cancel").addEventListener("click", () => element("begin").close());
    element("begin").addEventListener("submit", async (/** @type {Event} */ event) => {
      event.preventDefault();
      const way = /** @type {HTMLInputElement} */ (document.querySelector("input[name=way]:checked")).value;
      const given = { name: element("begin-name").value, base: way === "base" ? element("begin-base").value : "", chain: element("begin-chain").value, control: element("begin-control").value };
      element("begin").close();
      this.sample.lines = [];
      // What is typed into the old definition now would be typed in vain.
      document.body.inert = true;
      this.edits.add({ what: "begin", given, settle: () => {} });
      if (!await this.edits.settled()) this.edits.queue = this.edits.queue.filter((each) => each.what !== "begin");
      document.body.inert = false;
      element("start").focus();
    });
    element("save").addEventListener("click", () => {
      if (!this.data) { this.begin(); return; }
      element("save-why").textContent = "";
      element("save-replace").hidden = true;
      element("save-name").value = element("title").textContent;
      element("saving").showModal();
      element("save-name").focus();
    });
    element("saving").addEventListener("submit", (/** @type {Event} */ event) => {
      event.preventDefault();
      this.save(false);
    });
    element("save-replace").addEventListener("click", () => this.save(true));
    element("save-cancel").addEventListener("click", () => element("saving").close());
    element("cl").addEventListener("change", async () => {
      const file = element("cl").files[0];
      if (!file) return;
      if (file.size > MOST_CL) { this.tell(say("many"), true); return; }
      const url = await new Promise((done) => { const reader = new FileReader(); reader.onload = () => done(reader.result); reader.readAsDataURL(file); });
      this.cl = { name: file.name, content: String(url).split(",")[1] ?? "" };
      this.sample.lines = [];
      await this.runSample();
    });
    window.addEventListener("keydown", (event) => {
      const target = /** @type {HTMLElement} */ (event.target);
      const isElsewhere = document.querySelector("dialog[open]") || (target.matches("input, select, textarea") && target !== this.editor.area);
      if (!isElsewhere) this.editor.undoKey(event);
      if (event.key !== "s" || !(event.ctrlKey || event.metaKey)) return;
      event.preventDefault();
      if (element("saving").open) this.save(false);
      else if (!element("begin").open) element("save").click();
    });
    window.addEventListener("beforeunload", (event) => { if (this.editor.text !== this.saved || this.form.held.size || this.edits.queue.length) event.preventDefault(); });
  }
}

putTexts();
const builder = new Builder(JSON.parse(element("scene").textContent));
/** @type {any} */ (window).builder = builder;
const ready = () => { document.documentElement.dataset.ready = "true"; };
if (builder.start.text) {
  builder.editor.set(builder.start.text);
  builder.edits.rested().then(ready);
} else { builder.begin(); ready(); }
