"""The queue of changes of the builder's page, without a page: whatever comes when, nothing that was entered is lost."""

import os
import shutil
import subprocess

import pytest

from tests.support.locations import ROOT

NODE = shutil.which("node")
MODULE = ROOT / "src" / "trunnion" / "builder" / "web" / "edits.js"

pytestmark = pytest.mark.skipif(
    not NODE and not os.environ.get("CI"), reason="there is no node (Debian package nodejs)"
)

#: The text of a page is letters that are typed and marks that changes add; the server answers when it is told to.
PAGE = """
import { readFileSync } from "node:fs";
import { strict as assert } from "node:assert";
const { Edits } = await import("data:text/javascript," + encodeURIComponent(readFileSync(process.argv[1], "utf-8")));

function makePage() {
  const page = { text: "", asked: [], shown: [], most: 0, settled: [] };
  page.edits = new Edits({
    text: () => page.text,
    post: (what, given) => new Promise((resolve) => {
      page.asked.push({ what, given, resolve });
      page.most = Math.max(page.most, page.asked.length);
    }),
    show: (answer, edit) => { page.shown.push(answer); if (edit) page.text = answer.text; },
  });
  page.change = (mark) => page.edits.add({ what: "change", given: { mark }, settle: () => page.settled.push(mark) });
  page.type = (letter) => { page.edits.typed(); page.text += letter; };
  page.answer = async (isThere = true) => {
    const { given, resolve } = page.asked.shift();
    resolve(isThere ? { text: given.text + (given.mark ?? "") } : null);
    await new Promise((done) => setImmediate(done));
  };
  page.finish = async () => { page.edits.rested(); while (page.asked.length) await page.answer(); };
  return page;
}
"""


def run(script: str) -> None:
    """Run a script over the module in Node, which ends with an error where an assertion fails."""
    command = [str(NODE), "--input-type=module", "--eval", PAGE + script, str(MODULE)]
    found = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    assert found.returncode == 0, found.stderr


def test_each_change_is_asked_for_with_the_text_of_the_one_before() -> None:
    run("""
const page = makePage();
for (const mark of "1234") page.change(mark);
assert.equal(page.asked.length, 1);
await page.finish();
assert.equal(page.text, "1234");
assert.deepEqual(page.settled, ["1", "2", "3", "4"]);
assert.ok(page.edits.isIdle);
""")


def test_an_answer_to_an_older_text_is_not_shown() -> None:
    run("""
const page = makePage();
page.type("a");
page.edits.rested();
page.type("b");
await page.answer();
assert.deepEqual([page.text, page.shown.length, page.asked.length], ["ab", 0, 0]);
await page.finish();
assert.deepEqual(page.shown, [{ text: "ab" }]);
""")


def test_a_change_is_asked_for_again_when_the_text_has_changed() -> None:
    run("""
const page = makePage();
page.change("1");
page.type("a");
await page.answer();
assert.deepEqual([page.text, page.settled.length, page.asked.length], ["a", 0, 0]);
await page.finish();
assert.equal(page.text, "a1");
""")


def test_a_change_waits_for_a_server_that_is_gone() -> None:
    run("""
const page = makePage();
page.change("1");
const isSettled = page.edits.settled();
await page.answer(false);
assert.equal(await isSettled, false);
assert.equal(page.asked.length, 0);
const isSettledThen = page.edits.settled();
await page.answer();
assert.equal(await isSettledThen, true);
assert.equal(page.text, "1");
""")


def test_whatever_comes_when_nothing_is_lost() -> None:
    """Keys, rests, changes, and answers of a server that is there or not, in 2,000 orders by a fixed generator."""
    run("""
let state = 1;
const random = (n) => { state = (state * 48271) % 2147483647; return state % n; };
for (let round = 0; round < 2000; round++) {
  const page = makePage();
  const typed = [], marks = [];
  for (let k = 0; k < 25; k++) {
    const what = random(5);
    if (what === 0) { typed.push(`a${k}.`); page.type(typed.at(-1)); }
    if (what === 1) { marks.push(`M${k}.`); page.change(marks.at(-1)); }
    if (what === 2) page.edits.rested();
    if (what > 2 && page.asked.length) await page.answer(random(6) > 0);
  }
  const isSettled = page.edits.settled();
  await page.finish();
  assert.equal(await isSettled, true);
  assert.equal(page.most, 1);
  assert.deepEqual(page.text.match(/a\\d+\\./g) ?? [], typed);
  assert.deepEqual(page.text.match(/M\\d+\\./g) ?? [], marks);
  assert.deepEqual(page.settled, marks);
  assert.ok(page.edits.isIdle);
  if (page.shown.length) assert.equal(page.shown.at(-1).text, page.text);
}
""")
