// Elements without innerHTML: titles and names come from users.

/** Makes an element: attributes, `on...` listeners, children (elements or texts). */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  fill(element, attributes, children);
  return element;
}

/** The same for SVG. */
export function s(tag, attributes = {}, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  fill(element, attributes, children);
  return element;
}

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat(Infinity).filter(child => child !== null && child !== undefined && child !== false));
}

/** A part of the page with a heading that the contents list finds. */
export function section(id, title, ...children) {
  return h('section', { id, 'aria-labelledby': `${id}-title` }, h('h2', { id: `${id}-title` }, title), ...children);
}

/** A button of a group of which one is pressed. */
export function choice(label, options, start, change) {
  const buttons = options.map(([value, text]) =>
    h('button', { type: 'button', 'aria-pressed': String(value === start), onclick: () => pick(value) }, text));
  const pick = value => {
    buttons.forEach((button, i) => button.setAttribute('aria-pressed', String(options[i][0] === value)));
    change(value);
  };
  return h('div', { class: 'choice', role: 'group', 'aria-label': label }, buttons);
}

/** A select box with its label. */
export function select(label, options, start, change) {
  const box = h('select', { onchange: () => change(box.value) },
    options.map(([value, text]) => h('option', { value, selected: value === start }, text)));
  return h('label', { class: 'field' }, h('span', {}, label), box);
}

/** A table of a head and rows; cells are texts or elements, those of classes `num` are numbers. */
export function table(head, rows, options = {}) {
  const cell = (tag, content, i) =>
    h(tag, { class: options.numbers?.includes(i) ? 'num' : undefined, scope: tag === 'th' ? 'col' : undefined }, content ?? '');
  return h('div', { class: 'scroll' }, h('table', {},
    options.caption ? h('caption', {}, options.caption) : null,
    h('thead', {}, h('tr', {}, head.map((text, i) => cell('th', text, i)))),
    h('tbody', {}, rows.map(row => h('tr', {}, row.map((content, i) => cell('td', content, i)))))));
}
