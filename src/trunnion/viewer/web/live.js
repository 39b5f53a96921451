// A machine as it moves: its poses take the place of those of the cursor as long as the page follows it.

import { say } from "./texts.js";

/**
 * @typedef {{program: import("./program.js").Program, row: number, playing: boolean, play: () => void,
 *   showMachineAt: (values: number[], row: number) => void}} Shown
 */

/**
 * Show the poses that the server tells, while a box is ticked.
 * @param {Shown} page
 * @param {HTMLElement} place for the box
 */
export function followMachine(page, place) {
  const label = document.createElement("label"), box = document.createElement("input"), state = document.createElement("output");
  Object.assign(box, { type: "checkbox", id: "live", checked: true });
  state.id = "live-state";
  label.append(box, say("live"));
  place.append(label, state);
  const follow = () => { if (page.playing) page.play(); };
  follow();
  box.addEventListener("change", follow);
  /** What is shown is old once nothing says where the machine is. */
  const tell = (/** @type {boolean} */ gone) => {
    state.textContent = gone ? say("liveGone") : "";
    document.body.classList.toggle("gone", gone && box.checked);
  };
  const source = new EventSource("live");
  source.onmessage = (event) => {
    /** @type {{values: number[] | null, line: number, file: number}} */
    const told = JSON.parse(event.data);
    tell(!told.values);
    if (!told.values || !box.checked) return;
    const { program } = page;
    const row = told.line > 0 && program.rows ? program.rowOfLine(told.file, told.line, page.row) : page.row;
    page.showMachineAt(told.values, row);
  };
  source.onerror = () => tell(true);
}
