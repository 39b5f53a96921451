// Elements of the page, and what is written into them.

/**
 * @param {string} id
 * @returns {any}
 */
export const element = (id) => document.getElementById(id);

/** @param {string} text */
export function escaped(text) {
  const box = document.createElement("span");
  box.textContent = text;
  return box.innerHTML;
}

/**
 * A text in which no minus is parted from its number: ``X-41.5`` at the end of a line would read as positive.
 * @param {string} text
 */
export function prose(text) {
  const parts = text.split(/((?<![\w-])[A-Za-z]{0,2}-\d[\d.]*)/);
  return parts.map((part, k) => (k % 2 ? Object.assign(document.createElement("span"), { className: "nb", textContent: part }) : part));
}

/** @param {number} seconds */
export function clock(seconds) {
  const whole = Math.floor(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}.${Math.floor((seconds - whole) * 10)}`;
}

/**
 * @param {string} address
 * @param {string} name
 */
export function save(address, name) {
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
}
