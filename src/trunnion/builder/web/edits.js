// Changes of the definition, one after another: each is asked for with the text that the one before it gave.
//
// The text of the page is the only truth. An answer counts only if the text is still the one that was asked about; if
// the user has typed in it meanwhile, the question is put again, with the new text, when the keys rest.

/**
 * @typedef {{what: string, given: any, settle: () => void}} Edit a request that changes the text, and what its end lets go
 * @typedef {{text: () => string, post: (what: string, given: any) => Promise<any>, show: (answer: any, edit: Edit | undefined) => void}} Page
 *   post gives null if the server is gone
 */

export class Edits {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    /** @type {Edit[]} */
    this.queue = [];
    this.isTyping = false;
    this.isRunning = false;
    this.isUnjudged = false;
    /** @type {((isDone: boolean) => void)[]} */
    this.waiting = [];
  }

  /** Whether the page shows what the server says of its text, and no change is on its way. */
  get isIdle() { return !this.queue.length && !this.isRunning && !this.isTyping && !this.isUnjudged; }

  /** @param {Edit} edit */
  add(edit) {
    this.queue.push(edit);
    return this.#run();
  }

  /** The user is typing in the text. */
  typed() { this.isTyping = true; }

  /** The text is to be judged: its keys rest, or it is new. */
  rested() {
    this.isTyping = false;
    this.isUnjudged = true;
    return this.#run();
  }

  /**
   * Wait until every change is in the text; false: the server is gone, and some are not.
   * @returns {Promise<boolean>}
   */
  settled() {
    const done = new Promise((resolve) => this.waiting.push(resolve));
    this.#run();
    return done;
  }

  async #run() {
    if (this.isRunning) return;
    this.isRunning = true;
    let isGone = false;
    try {
      while (!isGone && !this.isTyping && (this.queue.length || this.isUnjudged)) isGone = !await this.#ask();
    } finally {
      this.isRunning = false;
    }
    if (!this.queue.length || isGone) this.waiting.splice(0).forEach((resolve) => resolve(!this.queue.length));
  }

  /** Put the next question; false: nobody is there to answer. */
  async #ask() {
    const edit = this.queue.at(0);
    const text = this.page.text();
    this.isUnjudged = false;
    const answer = await this.page.post(edit ? edit.what : "judge", { text, ...edit?.given });
    if (!answer || this.page.text() !== text) {
      this.isUnjudged = true;
      return Boolean(answer);
    }
    if (edit) {
      this.queue.shift();
      edit.settle();
    }
    this.page.show(answer, edit);
    return true;
  }
}
