// What is edited is kept in this browser, under one key; where it cannot be, leaving asks.

const KEPT = 'clatter';
const MOST_KEPT = 1 << 20; // characters: no product file is larger, and a browser has room for some millions
const kept = { example: undefined, lost: false };

const edits = ({ name, text }, { q, e, threshold }) => JSON.stringify({ name, text, q, e, threshold });

// Of the page as it begins nothing is kept.
function keep() {
  if (kept.example === undefined) return;
  const now = edits(product, bar);
  kept.lost = now !== kept.example;
  try {
    if (!kept.lost) localStorage.removeItem(KEPT);
    else if (now.length <= MOST_KEPT) {
      localStorage.setItem(KEPT, now);
      kept.lost = false;
    }
  } catch {
    // No room, or a browser that keeps nothing.
  }
  $('kept').textContent = kept.lost
    ? 'This browser cannot keep what you change: save it.'
    : 'What you change is kept in this browser; Undo, or a worked product, leads back.';
}

// What was kept, as far as it is what this page keeps.
function keptBefore() {
  try {
    const before = JSON.parse(localStorage.getItem(KEPT));
    const is = { name: 'string', text: 'string', q: 'number', e: 'number', threshold: 'number' };
    return Object.fromEntries(Object.entries(is).flatMap(([key, type]) => (typeof before[key] === type ? [[key, before[key]]] : [])));
  } catch {
    return {};
  }
}

addEventListener('beforeunload', (event) => {
  if (kept.lost) event.preventDefault();
});
