// What the page knows, and how old it is by now. Nothing here touches the document.
import {pageNow} from './connection.js';
import {isNumber} from './format.js';

// The same limits as the ground station's own view has: FleetRow::FreshS, FleetFreshS, and a snapshot a second.
const POSE_FRESH_S = 1.0;
const FLEET_FRESH_S = 3.0;
const LIVE_S = 1.5;
const PART_FRESH_S = {mission: 3.5, health: 3.5, targets: 2.5, camera: 2.5, picture: 10};

// A target that no camera has seen for longer may be anywhere by now.
const TARGET_SEEN_S = 30;

const URGENCY = ['lost', 'stale', 'alarm', 'warning', 'waiting', 'up'];
// Below these percentages an aircraft needs attention because of its battery. FleetTable.h has the same limits.
const BATTERY_ALARM = 10;
const BATTERY_WARNING = 25;

// '', 'warning' or 'alarm'.
export function batteryLevel(percent) {
  if (!isNumber(percent) || percent >= BATTERY_WARNING) return '';
  return percent < BATTERY_ALARM ? 'alarm' : 'warning';
}

// Where an aircraft says that it is; null: not known.
export function placeOf(aircraft) {
  const {latitude_deg: lat, longitude_deg: lng} = aircraft?.pose ?? {};
  return isNumber(lat) && isNumber(lng) ? {lat, lng} : null;
}

const NO_FIX_DEG = 0.001;

// Where it is, if its receiver has a fix: without one it tells 0, 0. Null also while its position is bad: the place in the
// snapshot is then the last good one.
export function fixOf(aircraft) {
  const place = aircraft?.bad_position ? null : placeOf(aircraft);
  return place && (Math.abs(place.lat) > NO_FIX_DEG || Math.abs(place.lng) > NO_FIX_DEG) ? place : null;
}

export class Model {
  snapshot = null;
  takenAt = -Infinity;
  connected = false;
  selected = null;
  markedNodes = new Set();  // those that an order to several goes to; they end with it, and with a selection
  forgotten = new Set();  // LOST aircraft that a person has dismissed from this page, until they are heard again
  received = 0;
  skipped = 0;

  take(snapshot, takenAt) {
    const last = this.snapshot;
    this.newLife = last !== null && last.life !== snapshot.life;
    if (last && !this.newLife) this.skipped += Math.max(0, snapshot.number - last.number - 1);
    this.snapshot = snapshot;
    for (const {node, state} of snapshot.aircraft) if (state !== 'lost') this.forgotten.delete(node);
    this.takenAt = takenAt;
    this.received += 1;
  }

  // Also those that a person has dismissed: they may still fly.
  get allAircraft() {
    return this.snapshot?.aircraft ?? [];
  }
  // Those that can take an order: nodes that only post poses, and replays, have no mission.
  get thoseWithAMission() {
    return this.allAircraft.filter(({mission, replay}) => mission && !replay);
  }
  // A replay that is over is no aircraft that is missing.
  isOverReplay(aircraft) {
    return aircraft.replay === true && this.state(aircraft) === 'lost';
  }
  get aircraft() {
    return this.allAircraft.filter(({node}) => !this.forgotten.has(node));
  }
  forget(node) {
    this.forgotten.add(node);
    this.markedNodes.delete(node);
    if (this.selected === node) this.selected = null;
  }
  // What needs attention first: LOST, STALE, a low battery, WAITING, UP, replays that are over; within each by name.
  get byUrgency() {
    const urgency = (one) => {
      if (this.isOverReplay(one)) return URGENCY.length;
      const state = this.state(one);
      const level = one.bad_position && state === 'up' ? 'warning' : state;
      return URGENCY.indexOf((this.isFresh(one, 'health') && batteryLevel(one.health.battery_percent)) || level);
    };
    const rank = new Map(this.aircraft.map((one) => [one, urgency(one)]));
    return [...this.aircraft].sort((a, b) => rank.get(a) - rank.get(b));
  }
  // Nodes whose messages were recorded before.
  get replayed() {
    return this.snapshot?.replayed ?? [];
  }
  find(node) {
    return this.aircraft.find((one) => one.node === node) ?? null;
  }
  // In the order of the list.
  get marked() {
    return this.byUrgency.map(({node}) => node).filter((node) => this.markedNodes.has(node));
  }
  mark(node) {
    if (!this.markedNodes.delete(node)) this.markedNodes.add(node);
  }
  // A selection ends the marks, unless they are kept: an order is for the aircraft that were chosen last.
  select(node, keepsMarks = false) {
    this.selected = node;
    if (!keepsMarks) this.endMarks();
  }
  endMarks() {
    this.markedNodes.clear();
  }
  // Those that a Search or a Home is for.
  get receivers() {
    const {marked, selectedAircraft: selected} = this;
    return marked.length > 0 ? marked : selected ? [selected.node] : [];
  }
  get selectedAircraft() {
    return this.find(this.selected);
  }

  // Seconds since the snapshot was made.
  get staleness() {
    return Math.max(0, pageNow() - this.takenAt);
  }
  // Whether what is shown is of now.
  get live() {
    return this.connected && this.staleness <= LIVE_S;
  }
  // The age now of something that had that age in the snapshot.
  age(ageInSnapshot) {
    return isNumber(ageInSnapshot) ? ageInSnapshot + this.staleness : NaN;
  }

  // Whether what the gateway tells of nodes and problems is of now.
  get fleetFresh() {
    return this.live && this.age(this.snapshot?.fleet_age_s) <= FLEET_FRESH_S;
  }
  state(aircraft) {
    if (aircraft.state !== 'up') return aircraft.state;
    return this.fleetFresh ? 'up' : 'stale';
  }
  isPoseFresh(aircraft) {
    return this.state(aircraft) === 'up' && this.age(aircraft.pose?.age_s) <= POSE_FRESH_S;
  }
  isFresh(aircraft, part) {
    return this.state(aircraft) === 'up' && this.age(aircraft[part]?.age_s) <= PART_FRESH_S[part];
  }
  // What is missing of an aircraft, or of what stands between it and the page; empty if nothing is.
  missing(aircraft) {
    if (!this.live) return 'no connection to the ground station';
    if (!this.fleetFresh) return 'the gateway of the ground station is silent';
    if (aircraft.state === 'waiting') return '';
    const beats = aircraft.state === 'up';
    if (beats && aircraft.bad_position) return `bad position: ${aircraft.bad_position}`;
    const poses = this.age(aircraft.pose?.age_s) <= POSE_FRESH_S;
    if (beats && poses) return '';
    // Beats count for some time after the last one, so this does not say that it is heard.
    if (beats) return aircraft.pose ? 'no position comes' : 'no position has come yet';
    return poses ? 'only its positions come' : 'nothing comes from it';
  }
  // As on the map and in its sign: an aircraft that is UP but whose pose is old is shown as STALE there.
  shownState(aircraft) {
    const state = this.state(aircraft);
    return state === 'up' && aircraft.pose && !this.isPoseFresh(aircraft) ? 'stale' : state;
  }

  // The targets, each once, by the name that the fleet gives it. Of one that no vision tells of only the last
  // position is known, and not how old that is.
  get targets() {
      return (this.snapshot?.targets ?? []).map((one) => {
          const teller = this.find(one.told_by);
          const age = teller ? this.age(one.age_s + (one.unseen_s ?? 0)) : NaN;
          return {
              ...one,
              validatedBy: one.validated_by,
              age,
              fresh: teller !== null && this.state(teller) === 'up' && age <= TARGET_SEEN_S &&
                  this.age(one.age_s) <= PART_FRESH_S.targets,
          };
      });
  }
}
