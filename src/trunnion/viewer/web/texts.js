// What a page says: texts of its catalogue in the language of who looks, which stand in the page as data.

/** A part of a text that is filled in: a value by its name, or a number with what it counts. */
const VALUE = /\{(\w+)(?::([^}]*))?\}/g;

/** @type {Record<string, string>} */
const TEXTS = JSON.parse(/** @type {string} */ (document.getElementById("texts")?.textContent));

/**
 * A text of the page by its key, with its values by their names.
 * @type {<Key extends keyof PageTexts>(key: Key, ...values: PageTexts[Key]) => string}
 */
export const say = (key, ...values) => {
  /** @type {Record<string, string | number>} */
  const given = values[0] ?? {};
  return (TEXTS[String(key)] ?? String(key)).replace(VALUE, (_, name, forms) => {
    const [one, more = one] = (forms ?? "#").split("|");
    return (Number(given[name]) === 1 ? one : more).replace("#", () => String(given[name]));
  });
};

/** Put the texts of the page where its body has keys for them. */
export function putTexts() {
  const keyed = (/** @type {string} */ name) => /** @type {HTMLElement[]} */ (Array.from(document.querySelectorAll(`[data-${name}]`)));
  for (const each of keyed("say")) each.textContent = say(/** @type {PlainKey} */ (each.dataset.say));
  for (const each of keyed("label")) {
    const text = say(/** @type {PlainKey} */ (each.dataset.label));
    each.setAttribute("aria-label", text);
    if (each.matches("button, input, select")) each.title = text;
  }
  for (const each of keyed("hint")) each.setAttribute("placeholder", say(/** @type {PlainKey} */ (each.dataset.hint)));
}
