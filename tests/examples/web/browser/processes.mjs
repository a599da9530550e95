// The programs under test. All of them are ended when the test ends, however it ends.
import {spawn} from 'node:child_process';
import {readFileSync} from 'node:fs';

const running = new Set();

export class Program {
  constructor(path, args) {
    this.name = path.split('/').pop();
    this.output = '';
    // setpriv: the kernel ends it even if this test is killed.
    this.process = spawn('setpriv', ['--pdeathsig', 'KILL', path, ...args], {stdio: ['pipe', 'pipe', 'pipe']});
    this.pid = this.process.pid;
    for (const stream of [this.process.stdout, this.process.stderr])
      stream.setEncoding('utf8').on('data', (text) => (this.output += text));
    this.ended = new Promise((resolve) => this.process.on('exit', (code, signal) => {
      running.delete(this);
      resolve(signal ?? code);
    }));
    this.process.stdin.on('error', () => {});
    running.add(this);
  }
  tell(line) {
    this.process.stdin.write(`${line}\n`);
  }
  async end(signal = 'SIGKILL') {
    this.process.kill(signal);
    return this.ended;
  }
  // Until the output matches; returns the match.
  async says(pattern, what = pattern) {
    return becomes(() => this.output.match(pattern), `${this.name} says ${what}; it said:\n${this.output.slice(-2000)}`);
  }
}

export async function endAll() {
  await Promise.all([...running].map((program) => program.end()));
}

// Polls until the value is true, for so long that it never will be otherwise. Returns the value.
export async function becomes(value, what) {
  const end = Date.now() + 180_000;
  for (;;) {
    const now = await value();
    if (now) return now;
    if (Date.now() > end) throw new Error(`never: ${typeof what === 'function' ? await what() : what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

// A DDS domain that nobody on this machine uses: the port that every process of it listens on is free (OMG DDSI-RTPS 2.3,
// 9.6.1.1).
export function freeDomain() {
  const used = readFileSync('/proc/net/udp', 'utf8');
  const first = Math.floor(Math.random() * 80);
  for (let i = 0; i < 80; i++) {
    const domain = 20 + ((first + i) % 80);
    const port = (7400 + 250 * domain).toString(16).toUpperCase().padStart(4, '0');
    if (!used.includes(`:${port} `)) return domain;
  }
  throw new Error('no DDS domain is free');
}
