// Runs one case: run_case.mjs CASE FOLDER_OF_PROGRAMS ROOT. Exit status 0: passed.
import {cases as fixtureCases} from './fixture_cases.mjs';
import {cases as fleetCases} from './fleet_cases.mjs';
import {cases as lookCases} from './look_cases.mjs';
import {cases as mapCases} from './map_cases.mjs';
import {cases as operatorCases} from './operator_cases.mjs';
import {cases as orderCases} from './order_cases.mjs';
import {closeBrowser} from './page.mjs';
import {endAll} from './processes.mjs';

const [name, bin, root] = process.argv.slice(2);
const run = {...fixtureCases, ...fleetCases, ...lookCases, ...mapCases, ...operatorCases, ...orderCases}[name];
if (!run) {
  console.error(`there is no case ${name}`);
  process.exit(2);
}

async function end(status) {
  await closeBrowser().catch((error) => console.error(error));
  await endAll();
  process.exit(status);
}
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.on(signal, () => end(130));

try {
  await run({bin, root});
  console.log(`passed: ${name}`);
  await end(0);
} catch (error) {
  console.error(`FAILED: ${name}: ${error.stack}`);
  await end(1);
}
