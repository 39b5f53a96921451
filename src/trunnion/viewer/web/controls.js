// What controls and keys do.

import { element, save } from "./elements.js";

/** Keys that a slider or a text that has the focus takes itself. */
const OF_SLIDERS = new Set(["ArrowLeft", "ArrowRight", "Home", "End"]);

/**
 * Have the controls and keys do what they say.
 * @param {import("./page.js").Page} page
 */
export function listen(page) {
  const on = (/** @type {string} */ id, /** @type {string} */ kind, /** @type {(event: any) => void} */ done) => element(id).addEventListener(kind, done);
  on("play", "click", () => page.play());
  on("first", "click", () => page.goToRow(0));
  on("back", "click", () => page.goToRow(page.row - 1));
  on("step", "click", () => page.goToRow(page.row + 1));
  on("last", "click", () => page.goToRow(page.program.rows - 1));
  on("scrub", "input", (event) => { page.space.hurry(true); page.goTo(Number(event.target.value) * page.program.end); });
  on("scrub", "change", () => page.space.hurry(false));
  on("speed", "input", () => page.tellSpeed());
  on("colour", "change", () => page.colours.paint());
  on("stock", "change", () => page.showStock());
  on("view", "change", (event) => page.look(event.target.value, true));
  on("frame", "change", (event) => page.setFrame(event.target.value));
  on("section", "change", () => page.section());
  on("section-at", "input", () => page.section());
  on("bodies", "change", (event) => page.spaces.forEach((space) => space.showMachine(event.target.checked)));
  on("path", "change", (event) => page.spaces.forEach((space) => space.showPath(event.target.checked)));
  on("file", "change", (event) => page.chooseFile(Number(event.target.value)));
  on("search", "keydown", (event) => { if (event.key === "Enter") page.search(event.shiftKey); });
  on("measure", "click", () => page.measure());
  on("picture", "click", () => page.picture());
  on("csv", "click", () => save(URL.createObjectURL(new Blob([page.curves.csv()], { type: "text/csv" })), "curves.csv"));
  on("help", "click", () => element("keys").showModal());
  on("close", "click", () => element("keys").close());
  let down = [0, 0];
  on("space", "pointerdown", (event) => { down = [event.clientX, event.clientY]; });
  on("space", "pointerup", (event) => { if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) page.pickAt(event); });
  document.addEventListener("keydown", (event) => pressed(page, event));
  page.tellSpeed();
}

/**
 * @param {import("./page.js").Page} page
 * @param {KeyboardEvent} event
 */
function pressed(page, event) {
  const target = /** @type {HTMLElement} */ (event.target);
  if (event.ctrlKey || event.metaKey || event.altKey || target.matches("input[type=search], select") || element("keys").open) return;
  // Controls keep the keys that are theirs: the space bar presses and ticks, arrows move a slider, Home scrolls a text.
  if (event.key === " " && target.matches("button, input, summary")) return;
  if (OF_SLIDERS.has(event.key) && target.matches("input[type=range], #listing, #listing-b")) return;
  const rows = (/** @type {string} */ kind) => page.scene.events.filter((each) => each.kind.startsWith(kind)).map((each) => each.row);
  /** @type {Record<string, () => void>} */
  const keys = {
    " ": () => page.play(), ArrowRight: () => page.goToRow(page.row + 1), ArrowLeft: () => page.goToRow(page.row - 1),
    Home: () => page.goToRow(0), End: () => page.goToRow(page.program.rows - 1),
    "+": () => page.changeSpeed(0.05), "-": () => page.changeSpeed(-0.05),
    n: () => page.jumpToFinding(1), N: () => page.jumpToFinding(-1),
    t: () => page.jump(rows("tool"), 1), T: () => page.jump(rows("tool"), -1),
    o: () => page.jump(page.scene.operations.map((one) => one.first), 1), O: () => page.jump(page.scene.operations.map((one) => one.first), -1),
    r: () => page.jump(rows("rewind"), 1), R: () => page.jump(rows("rewind"), -1),
    1: () => page.look("iso"), 2: () => page.look("top", true), 3: () => page.look("front", true), 4: () => page.look("right", true),
    f: () => { const other = element("frame").value === "part" ? "machine" : "part"; element("frame").value = other; page.setFrame(other); },
    s: () => page.nextStock(),
    "/": () => element("search").focus(), m: () => page.measure(), p: () => page.picture(), "?": () => element("keys").showModal(),
  };
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
}
