// Small helpers for the document. Text goes in as text, never as markup.

export const byId = (id) => document.getElementById(id);

export function element(tag, className = '', text = '') {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text) made.textContent = text;
  return made;
}

// These touch the document only if something changes: at ten snapshots a second that is what costs.
export function setText(target, text) {
  if (target.textContent !== text) target.textContent = text;
}
export function setClass(target, className) {
  if (target.className !== className) target.className = className;
}
export function setAttribute(target, name, value) {
  if (target.getAttribute(name) !== value) target.setAttribute(name, value);
}

// Keeps one child of `parent` for each item, in the order of the items. `make` makes the child of a new key, `update`
// fills it in.
export function keepList(parent, children, items, keyOf, make, update) {
  const seen = new Set();
  let place = parent.firstElementChild;
  for (const item of items) {
    const key = keyOf(item);
    seen.add(key);
    let child = children.get(key);
    if (!child) {
      child = make(item);
      children.set(key, child);
    }
    if (child.root === place) place = place.nextElementSibling;
    else parent.insertBefore(child.root, place);
    update(child, item);
  }
  for (const [key, child] of children) {
    if (seen.has(key)) continue;
    child.root.remove();
    children.delete(key);
  }
}
