// Alarms: an operator has to act on each of them now. They are in the operator's words. Problems of programs and networks are in a
// list of their own.
import {byId, element, keepList, setAttribute, setText} from './dom.js';
import {ageWithUnit, fixed} from './format.js';
import {batteryLevel} from './model.js';

const TITLE = document.title;
const TONE = {hertz: [880, 660, 880], seconds: 0.18, loudness: 0.3};

// [{key, node, text}], the aircraft that needs attention most first.
export function alarmsOf(model) {
  const found = [];
  const {snapshot} = model;
  if (!snapshot || !model.live) return found;  // the banner says so
  const add = (kind, node, text) => found.push({key: `${kind}|${node}`, node, text});
  if (!model.fleetFresh) {
    add('gateway', '', 'The gateway of this ground station is silent: nothing is known of any aircraft.');
    return found;
  }
  for (const one of model.byUrgency) {
    const {node, health} = one;
    if (one.replay) continue;
    const isLost = one.state === 'lost';
    // One that said goodbye was switched off.
    if (isLost && one.reason !== 'left') add('lost', node, `is LOST: it has not been heard for ${ageWithUnit(model.age(one.heard_s))}`);
    if (isLost) continue;
    const told = model.isFresh(one, 'health');
    if (told && batteryLevel(health.battery_percent) === 'alarm')
      add('battery', node, `battery ${fixed(health.battery_percent, 0)} %: it has to land soon`);
    else if (told && health.wants_home) add('home', node, `flies home by itself${health.reason ? `: ${health.reason}` : ''}`);
    if (one.bad_position) add('position', node, `its position cannot be true: ${one.bad_position}`);
    if (one.without_orders) add('orders', node, 'started again, and waits for an order');
  }
  return found;
}

export class Alarms {
  constructor(model, say) {
    this.model = model;
    this.say = say;
    this.items = new Map();
    this.known = new Set();
    this.audio = null;  // no sound until a person has switched it on: browsers allow none before
    byId('sound').addEventListener('click', () => this.switchSound());
    this.showSound();
  }
  update() {
    const alarms = alarmsOf(this.model);
    const fresh = alarms.filter(({key}) => !this.known.has(key));
    const keys = alarms.map(({key}) => key);
    // While the connection or the gateway is silent it is not known which alarms are over.
    this.known = new Set(this.model.fleetFresh ? keys : [...this.known, ...keys]);
    if (fresh.length > 0) {
      this.sound();
      this.say(`Alarm: ${fresh.map(({node, text}) => `${node} ${text}`.trim()).join('. ')}`);
    }
    byId('alarms-panel').hidden = alarms.length === 0;
    const count = `■ ${alarms.length} ${alarms.length === 1 ? 'alarm' : 'alarms'}`;
    setText(byId('alarms-title'), count);
    const title = alarms.length > 0 ? `${count} · ${TITLE}` : TITLE;
    if (document.title !== title) document.title = title;
    keepList(byId('alarms'), this.items, alarms, ({key}) => key, () => {
      const item = {root: element('li', 'alarm'), who: element('span', 'who'), what: element('span', 'what')};
      item.root.append(item.who, item.what);
      return item;
    }, ({who, what}, {node, text}) => {
      setText(who, node);
      setText(what, text);
    });
  }
  // Off, or on. The tone is played as a test.
  switchSound() {
    if (this.audio) {
      this.audio.close();
      this.audio = null;
    } else {
      this.audio = new AudioContext();
      this.sound();
    }
    this.showSound();
  }
  showSound() {
    setText(byId('sound-state'), this.audio ? 'on' : 'off');
    setAttribute(byId('sound'), 'aria-pressed', String(this.audio !== null));
  }
  sound() {
    const {audio} = this;
    if (!audio) return;
    TONE.hertz.forEach((hertz, i) => {
      const tone = audio.createOscillator();
      const volume = audio.createGain();
      tone.frequency.value = hertz;
      volume.gain.value = TONE.loudness;
      tone.connect(volume).connect(audio.destination);
      tone.start(audio.currentTime + i * TONE.seconds);
      tone.stop(audio.currentTime + (i + 1) * TONE.seconds);
    });
  }
}
