// Elements of the page.

const $ = (id) => document.getElementById(id);

function element(name, attributes = {}, ...children) {
  return filled(document.createElement(name), attributes, children);
}

function drawn(name, attributes = {}, ...children) {
  return filled(document.createElementNS('http://www.w3.org/2000/svg', name), attributes, children);
}

function filled(node, attributes, children) {
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else if (value !== undefined && value !== false) node.setAttribute(key, value === true ? '' : value);
  }
  node.append(...children.filter((child) => child !== undefined));
  return node;
}

// So many significant digits, as people write them.
function digits(x, count = 4) {
  if (typeof x !== 'number') return x === null || x === undefined ? '–' : String(x);
  if (x === 0) return '0';
  const size = Math.abs(x);
  return (size >= 1e6 || size < 1e-4 ? x.toExponential(count - 1) : Number(x).toPrecision(count)).replace('-', '−');
}

// A command line, or the text of an answer, that can be copied.
function command(line, answer) {
  const box = element('div', { class: 'command' }, element('code', { tabindex: 0 }, line), copier('Copy', line, 'command'));
  if (answer) box.append(copier('Copy answer', answer, 'answer as JSON'));
  return box;
}

function copier(label, text, what) {
  const button = element('button', { type: 'button', 'aria-label': `Copy the ${what}` }, label);
  button.onclick = () => {
    const byHand = () => told('Press Ctrl-C in the line');
    if (navigator.clipboard) navigator.clipboard.writeText(text).then(() => told('Copied'), byHand);
    else byHand();
  };
  const told = (word) => {
    button.textContent = word;
    setTimeout(() => {
      button.textContent = label;
    }, 1500);
  };
  return button;
}

// Figures are files of their own: they can be saved, and no text of a product is read as markup of the page.
function figure([name, svg]) {
  const image = element('img', { alt: name, src: `data:image/svg+xml,${encodeURIComponent(svg)}` });
  return element('figure', { tabindex: 0 }, image, element('figcaption', {}, name));
}

function download(name, text) {
  const link = element('a', { download: name, href: URL.createObjectURL(new Blob([text], { type: 'text/plain' })) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

// What went wrong, in a place of its own; nothing is taken away for it.
function problem(place, error) {
  if (error instanceof Stopped) return;
  place.textContent = error ? error.message : '';
  place.hidden = !error;
}
