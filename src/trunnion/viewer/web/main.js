// The start: what the page holds is read, and becomes what it shows.

import { readColumn, readScene } from "./data.js";
import { element } from "./elements.js";
import { Listing } from "./listing.js";
import { followMachine } from "./live.js";
import { Page } from "./page.js";
import { Program } from "./program.js";
import { readTextOnce } from "./program_text.js";
import { Space } from "./space.js";
import { Stock } from "./stock.js";
import { putTexts, say } from "./texts.js";
import { Twin } from "./twin.js";

/** @param {import("./data.js").SceneData} scene */
function remarksOf(scene) {
  const found = scene.tools.filter((tool) => !tool.known).map((tool) => say("toolForm", { tool: tool.name }));
  if (!scene.machine.zero) found.unshift(say("zero"));
  if (!scene.timed) found.push(say("untimed"));
  if (scene.against?.pairs === 0) found.push(say("apart"));
  return [...found, ...scene.remarks, ...(scene.stock?.remarks ?? [])];
}

/**
 * Read what the page holds of the stock, and show its controls.
 * @param {Stock} stock
 */
async function openStock(stock) {
  await stock.open();
  element("stock-label").hidden = false;
  for (const option of document.querySelectorAll("option[value=deviation]")) {
    const lacks = !stock.data.deviation;
    Object.assign(option, { hidden: lacks, disabled: lacks });
  }
}

/**
 * The second program, if there is one, with what the page has for it.
 * @param {import("./data.js").SceneData} scene
 * @param {Record<string, any>} columns
 * @param {Program} program
 */
function openTwin(scene, columns, program) {
  if (!scene.against) return null;
  document.body.classList.add("twin");
  const second = `${scene.against.title} (${scene.against.machine.name})`;
  // The title has both, each with the key of its machine: names may hold anything, so lengths part them.
  const rest = ` (${scene.machine.key}) | ${scene.against.title} (${scene.against.machine.key})`;
  const first = scene.title.slice(0, scene.title.length - rest.length);
  element("caption").textContent = `${first} (${scene.machine.name})`;
  element("caption-b").textContent = second;
  for (const id of ["space-b", "listing-b", "caption", "caption-b"]) element(id).hidden = false;
  return new Twin(element("space-b"), element("listing-b"), scene, columns, program, readTextOnce);
}

async function start() {
  putTexts();
  const scene = readScene();
  /** @type {Record<string, any>} */
  const columns = {};
  await Promise.all(Object.keys(scene.columns).map(async (name) => { columns[name] = await readColumn(scene, name); }));
  const program = new Program(scene, columns);
  const space = new Space(element("space"), program, columns);
  const file = element("file");
  scene.files.forEach((name, k) => file.append(new Option(name.split(/[\\/]/).pop(), String(k))));
  /** @type {Listing} */
  const listing = new Listing(element("listing"), (line) => page.goToLine(line));
  const stock = scene.stock ? new Stock(space, program, columns, element("stock-status")) : null;
  if (stock) await openStock(stock);
  /** @type {Page} */
  const page = new Page(program, space, listing, stock, openTwin(scene, columns, program));
  const paper = () => page.spaces.forEach((each) => each.setBackground(getComputedStyle(document.body).getPropertyValue("--sky").trim()));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { paper(); page.curves.redraw(); });
  paper();
  page.goToRow(0);
  stock?.setMode("cut");
  for (const each of page.spaces) { each.look("iso"); each.tryPace(); }
  element("remarks").textContent = remarksOf(scene).join(" ");
  element("status").textContent = "";
  if (scene.live) followMachine(page, element("live-place"));
  window.addEventListener("beforeprint", () => { element("paper").src = space.picture(); });
  element("title").title = scene.title;
  Object.assign(window, { page });
  document.documentElement.dataset.ready = "true";
}

start().catch((error) => { element("status").textContent = String(error); });
