// The WebSocket to the ground station: connects again by itself, keeps the two clocks together, matches replies.

const RECONNECT_MS = [250, 500, 1000, 2000];
const CLOCK_PERIOD_MS = 2000;
const CLOCK_SAMPLES = 30;
const SILENCE_MS = 5000;  // without a snapshot the connection is given up, whatever the network says
const REPLY_MS = 5000;

// Seconds of a clock that never goes back, and that counts the time for which the computer slept as well.
export const pageNow = (() => {
  let now = 0;
  let lastTick = performance.now();
  let lastWall = Date.now();
  return () => {
    const tick = performance.now();
    const wall = Date.now();
    now += Math.max(0, tick - lastTick, wall - lastWall) / 1000;
    lastTick = tick;
    lastWall = wall;
    return now;
  };
})();

export class Connection {
  // onSnapshot(snapshot, takenAt): takenAt is the earliest moment, by pageNow(), at which it can have been made.
  // onState(open) tells of changes.
  constructor(onSnapshot, onState) {
    this.onSnapshot = onSnapshot;
    this.onState = onState;
    this.attempts = 0;
    this.isStranger = false;  // the ground station wants a token that this page does not have
    this.nextRef = 1;
    this.waiting = new Map();
    this.connect();
  }

  connect() {
    this.clockSamples = [];
    this.held = null;
    this.unseen = 0;
    this.opened = false;
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(`${scheme}//${location.host}/live`);
    this.socket = socket;
    socket.onopen = () => {
      this.attempts = 0;
      this.opened = true;
      this.listenFor();
      this.askClock();
      this.clockTimer = setInterval(() => this.askClock(), CLOCK_PERIOD_MS);
    };
    socket.onmessage = (event) => this.receive(JSON.parse(event.data));
    socket.onclose = () => this.lost(socket);
  }

  lost(socket) {
    if (socket !== this.socket) return;
    this.socket = null;
    clearInterval(this.clockTimer);
    clearTimeout(this.silenceTimer);
    for (const {reject} of this.waiting.values()) reject(new Error('the connection was lost: it may have been sent or not'));
    this.waiting.clear();
    this.onState(false);
    const pause = RECONNECT_MS[Math.min(this.attempts++, RECONNECT_MS.length - 1)];
    setTimeout(() => this.connectUnlessStranger(), pause);
  }

  // A WebSocket is not told why it is refused. Wrong tokens are counted: one that is wrong is not shown again and again.
  async connectUnlessStranger() {
    if (!this.opened) this.isStranger = await fetch('/', {method: 'HEAD'}).then((answer) => answer.status === 401, () => false);
    if (this.isStranger) this.onState(false);
    else this.connect();
  }

  listenFor() {
    clearTimeout(this.silenceTimer);
    const socket = this.socket;
    this.silenceTimer = setTimeout(() => {
      socket.onclose = null;
      socket.close();
      this.lost(socket);
    }, SILENCE_MS);
  }

  askClock() {
    if (this.socket?.readyState === WebSocket.OPEN)
      this.socket.send(JSON.stringify({type: 'clock', page_s: pageNow()}));
  }

  receive(message) {
    if (message.type === 'snapshot') {
      this.listenFor();
      this.held = message;
      this.unseen += 1;
    } else if (message.type === 'clock') {
      // The server's clock said so after page_s: it is never ahead of page time + offset. The smallest offset is the
      // best bound, and a slow line makes ages larger, never smaller.
      const first = this.clockSamples.length === 0;
      this.clockSamples.push(message.server_s - message.page_s);
      if (this.clockSamples.length > CLOCK_SAMPLES) this.clockSamples.shift();
      if (first) this.onState(true);
    } else if (message.type === 'reply') {
      const waiting = this.waiting.get(message.ref);
      this.waiting.delete(message.ref);
      if (!waiting) return;
      if (message.ok) waiting.resolve();
      else waiting.reject(new Error(message.reason));
    }
    if (this.held && this.clockSamples.length > 0) {
      const snapshot = this.held;
      this.held = null;
      this.onSnapshot(snapshot, snapshot.server_s - Math.min(...this.clockSamples));
    }
  }

  // The page has shown the latest snapshot: an answer for each that came, those that were passed over included.
  seen() {
    if (this.socket?.readyState !== WebSocket.OPEN) return;
    for (; this.unseen > 0; this.unseen--) this.socket.send('seen');
  }

  // Settles when the ground station has taken it or said why not.
  request(wish) {
    return new Promise((resolve, reject) => {
      if (this.socket?.readyState !== WebSocket.OPEN) {
        reject(new Error('there is no connection to the ground station: nothing was sent'));
        return;
      }
      const ref = this.nextRef++;
      this.waiting.set(ref, {resolve, reject});
      setTimeout(() => {
        if (this.waiting.delete(ref)) reject(new Error('the ground station does not answer: it may have been sent or not'));
      }, REPLY_MS);
      this.socket.send(JSON.stringify({...wish, ref}));
    });
  }
}
