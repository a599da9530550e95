// The lists beside the map: commands, targets, events; and the pictures under it.
import {ageText, ageWithUnit, clockTime, fixed, isNumber, STAGES, STATES} from './format.js';
import {countOf, isFlownByAll, outcomesOf} from './areas.js';
import {byId, element, keepList, setAttribute, setClass, setText} from './dom.js';

const STEPS = ['sent', 'delivered', 'accepted', 'done'];
// A search goes on until another command comes.
const wordOf = (kind, step) => (kind === 'search' && step === 'done' ? 'begun' : step);

export class CommandList {
  constructor(model) {
    this.model = model;
    this.items = new Map();
  }
  // Search areas are commands to the whole fleet, and stand among the others by the time at which they were given.
  update() {
    const {commands: all = [], areas = []} = this.model.snapshot ?? {};
    const commands = [
      ...all.map((one) => ({...one, key: `command ${one.number}`, age: one.sent_age_s})),
      ...areas.map((one, i) => ({...one, key: `area ${one.number}`, age: one.given_age_s, isArea: true, isWanted: i === areas.length - 1})),
    ].reverse().sort((a, b) => a.age - b.age);
    keepList(byId('commands'), this.items, commands, ({key}) => key, () => this.make(),
      (item, one) => (one.isArea ? this.fillArea(item, one) : this.fill(item, one)));
    byId('commands-empty').hidden = commands.length > 0;
  }
  make() {
    const root = element('li');
    const item = {root, number: element('span', 'nr'), who: element('span', 'who'), kind: element('span', 'kind'), what: element('span', 'what'), when: element('span', 'when')};
    root.append(item.number, item.who, item.kind, item.what, item.when);
    return item;
  }
  // How many aircraft fly the area, and why the others do not.
  fillArea(item, area) {
    setText(item.who, 'all');
    setText(item.kind, `area ${area.number}`);
    setText(item.when, ageWithUnit(this.model.age(area.given_age_s)));
    setAttribute(item.root, 'data-area', String(area.number));
    const isBad = area.isWanted && !isFlownByAll(area);
    const sign = isFlownByAll(area) ? '✓ ' : isBad ? '▲ ' : '';
    setText(item.what, [`${sign}${countOf(area)} fly area ${area.number}`, ...outcomesOf(area)].join('; '));
    setClass(item.what, isBad ? 'what bad' : 'what');
  }
  fill(item, command) {
    setText(item.number, String(command.number));
    setText(item.who, command.node);
    setText(item.kind, command.kind);
    setText(item.when, ageWithUnit(this.model.age(command.changed_age_s)));
    setAttribute(item.root, 'data-command', String(command.number));
    setAttribute(item.root, 'data-progress', command.progress);
    const shown = `${command.progress}|${command.reason}`;
    if (item.shown === shown) return;
    item.shown = shown;
    const at = STEPS.indexOf(command.progress);
    if (at >= 0) {
      // The way that it has come, and the way that it has to go.
      item.what.replaceChildren(...STEPS.flatMap((step, i) => {
        const way = i === at ? 'step reached now' : i < at ? 'step reached' : 'step';
        const made = element('span', way, wordOf(command.kind, step));
        if (i === at) made.setAttribute('aria-current', 'step');
        return i > 0 ? [element('span', i <= at ? 'step reached' : 'step', ' → '), made] : [made];
      }));
      if (command.progress === 'done') item.what.append(' ✓');
    } else {
      const good = command.progress === 'replaced';
      const reason = command.reason ? `: ${command.reason}` : '';
      item.what.replaceChildren(element('span', good ? '' : 'bad', `${good ? '⤳' : '✕'} ${command.progress}${reason}`));
    }
  }
}

export class TargetList {
  constructor(model) {
    this.model = model;
    this.items = new Map();
    this.body = byId('targets').tBodies[0];
  }
  update() {
    const {targets} = this.model;
    keepList(this.body, this.items, targets, (one) => one.name, () => {
      const root = element('tr');
      const cells = ['', 'stage', 'number', 'number age', ''].map((name) => element('td', name));
      root.append(...cells);
      return {root, cells};
    }, ({root, cells}, target) => {
      setText(cells[0], target.name);
      setText(cells[1], `${STAGES[target.stage] ?? '?'} ${target.stage}`);
      setText(cells[2], fixed(target.sigma_major_m, 1));
      setText(cells[3], isNumber(target.age) ? `${target.fresh ? '' : '! '}${ageText(target.age)}` : '–');
      const seenBy = new Set([...(target.seen_by ?? []), ...(target.validatedBy ? [target.validatedBy] : [])]);
      setText(cells[4], [...seenBy].join(', '));
      setClass(root, target.fresh ? '' : 'old');
    });
    byId('targets-empty').hidden = targets.length > 0;
  }
}

// What keeps data from flowing now, as the gateway of the ground station knows it.
export class ProblemList {
  constructor(model) {
    this.model = model;
    this.items = new Map();
  }
  update() {
    const {count: all = 0, items: first = []} = this.model.snapshot?.problems ?? {};
    // Those of a node that was dismissed are dismissed with it.
    const items = first.filter(({node}) => !this.model.forgotten.has(node));
    const count = all - (first.length - items.length);
    const fresh = this.model.fleetFresh;
    const panel = byId('problems-panel');
    panel.hidden = count === 0;
    setClass(panel, fresh ? 'panel problems' : 'panel problems old');
    setText(byId('problems-title'), `▲ ${count} ${count === 1 ? 'problem' : 'problems'}${fresh ? '' : ' (old)'}`);
    keepList(byId('problems'), this.items, items, (one) => `${one.node}|${one.subject}`, () => {
      const item = {root: element('li', 'warning'), who: element('span', 'who'), what: element('span', 'what')};
      item.root.append(item.who, item.what);
      return item;
    }, ({who, what}, one) => {
      setText(who, one.node);
      setText(what, `${one.subject}: ${one.reason}`);
    });
    const more = count - items.length;
    byId('problems-more').hidden = more <= 0;
    setText(byId('problems-more'), `and ${more} more`);
  }
}

export class EventList {
  static LONGEST = 200;
  constructor(model, say) {
    this.model = model;
    this.say = say;
    this.last = 0;
    this.list = byId('events');
  }
  update() {
    const {snapshot, newLife} = this.model;
    if (!snapshot || snapshot === this.shown) return;
    if (newLife || this.life !== snapshot.life) this.last = 0;
    const first = this.life === undefined;
    this.life = snapshot.life;
    this.shown = snapshot;
    const fresh = snapshot.events.filter((event) => event.number > this.last);
    if (fresh.length === 0) return;
    if (this.last > 0 && fresh[0].number > this.last + 1)
      this.add({weight: 'warning', node: '', text: `${fresh[0].number - this.last - 1} events came too fast to be shown`, age_s: 0});
    for (const event of fresh) this.add(event);
    this.last = fresh[fresh.length - 1].number;
    while (this.list.children.length > EventList.LONGEST) this.list.lastElementChild.remove();
    // All that is new for the ear, but not what was there before the page.
    if (!first) this.say(fresh.slice(-3).map(({node, text}) => `${node} ${text}`).join('. '));
  }
  add(event) {
    const item = element('li', event.weight);
    const sign = {warning: '▲ ', alarm: '■ '}[event.weight] ?? '';
    item.append(element('span', 'when', clockTime(this.model.age(event.age_s))), element('span', 'who', event.node),
      element('span', 'what', sign + event.text));
    this.list.prepend(item);
  }
}

export class Pictures {
  constructor(model, onSelect) {
    this.model = model;
    this.onSelect = onSelect;
    this.items = new Map();
    this.root = byId('pictures');
  }
  update() {
    const {model} = this;
    const shown = model.aircraft.filter(({picture}) => picture);
    this.root.hidden = shown.length === 0;
    keepList(this.root, this.items, shown, (one) => one.node, (one) => {
      const root = element('figure');
      const image = element('img');
      image.alt = `Camera of ${one.node}`;
      const caption = element('figcaption');
      const name = element('span', '', one.node);
      const age = element('span', 'state');
      caption.append(name, age);
      const frame = element('div', 'frame');
      frame.append(image);
      root.append(frame, caption);
      root.addEventListener('click', () => this.onSelect(one.node));
      return {root, image, age};
    }, (item, one) => {
      const {root, image, age} = item;
      const fresh = model.isFresh(one, 'picture');
      const state = model.state(one);
      setClass(root, fresh ? '' : `old ${state}`);
      setAttribute(root, 'aria-current', String(one.node === model.selected));
      setText(age, `${fresh ? '' : `${STATES[state === 'up' ? 'stale' : state].sign} OLD `}${ageWithUnit(model.age(one.picture.age_s))}`);
      // One at a time: a slow line loads the latest when the one before is there.
      const wanted = `/pictures/${encodeURIComponent(one.node)}?n=${one.picture.number}&life=${model.snapshot.life}`;
      if (item.wanted === wanted || (item.loading && !image.complete)) return;
      item.wanted = wanted;
      item.loading = true;
      image.src = wanted;
    });
  }
}
