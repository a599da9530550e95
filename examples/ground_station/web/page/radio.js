// What the radio of this ground station does: what limits it, how much is used, and what is held back.
import {ageWithUnit, fixed, isNumber} from './format.js';
import {byId, element, keepList, setClass, setText} from './dom.js';

function bytesPerSecond(value) {
  if (!isNumber(value)) return '–';
  if (value < 999.5) return `${fixed(value, 0)} B/s`;
  if (value < 999950) return `${fixed(value / 1e3, 1)} kB/s`;
  return value < 1e11 ? `${fixed(value / 1e6, 1)} MB/s` : '>99999 MB/s';
}
// A bare number of kB/s.
export function kilo(value) {
  if (!isNumber(value)) return '–';
  const number = value / 1e3;
  if (number > 0 && number < 0.005) return '<0.01';
  return number > 99999 ? '>99999' : fixed(number, number < 9.995 ? 2 : number < 99.95 ? 1 : 0);
}
const perSecond = (value) => `${isNumber(value) && value > 99999 ? '>99999' : fixed(value, value < 99.95 ? 1 : 0)}/s`;

function limits({budget, capacity}) {
  const said = [];
  if (isNumber(budget)) said.push(`budget ${bytesPerSecond(budget)}`);
  if (isNumber(capacity)) said.push(`the air carries ${bytesPerSecond(capacity)}`);
  return said;
}

// Commands first.
function heldBack({links, streams}) {
  return [
    ...links.items.map((one) => ({
      key: `link|${one.node}/${one.queue}`,
      name: `${one.node}/${one.queue}`,
      what: `${one.waiting} ${one.waiting === 1 ? 'waits' : 'wait'}${one.expired > 0 ? `, ${one.expired} expired` : ''}`,
    })),
    ...streams.items.map((one) => ({
      key: `stream|${one.message}`,
      name: one.message,
      what: `${perSecond(one.posted_per_s)} posted, ${perSecond(one.sent_per_s)} sent`,
    })),
  ];
}

export class RadioPanel {
  constructor(model) {
    this.model = model;
    this.items = new Map();
  }
  update() {
    const radio = this.model.snapshot?.radio ?? null;
    const panel = byId('radio-panel');
    panel.hidden = radio === null;
    if (!radio) return;
    const {air} = radio;
    const fresh = this.model.fleetFresh;
    const limited = limits(air);
    const said = [...(limited.length > 0 ? limited : ['not limited']), `${bytesPerSecond(air.used)} used`];
    const held = [];
    if (radio.streams.count > 0) held.push(`${perSecond(radio.posts_held_per_s).replace('/s', '')} posts/s`);
    if (radio.messages_held > 0) held.push(`${radio.messages_held} queue ${radio.messages_held === 1 ? 'message' : 'messages'}`);
    if (held.length > 0) said.push(`▲ held back: ${held.join(', ')}`);
    if (!fresh) said.push(`(${ageWithUnit(this.model.age(this.model.snapshot.fleet_age_s))} ago)`);
    const items = heldBack(radio);
    setClass(panel, `panel radio${items.length > 0 ? ' held' : ''}${fresh ? '' : ' old'}`);
    setText(byId('radio-summary'), said.join(' · '));
    const used = limited.length > 0 ? air.classes.filter(({rate}) => rate > 0).map(({name, rate}) => `${name} ${kilo(rate)}`) : [];
    setText(byId('radio-classes'), used.length > 0 ? `kB/s: ${used.join(' · ')}` : '');
    keepList(byId('radio-held'), this.items, items, (one) => one.key, () => {
      const item = {root: element('li', 'warning'), who: element('span', 'who'), what: element('span', 'what')};
      item.root.append(item.who, item.what);
      return item;
    }, ({who, what}, one) => {
      setText(who, one.name);
      setText(what, one.what);
    });
    byId('radio-list').hidden = items.length === 0;
    const more = radio.links.count + radio.streams.count - items.length;
    byId('radio-more').hidden = more <= 0;
    setText(byId('radio-more'), `and ${more} more`);
  }
}
