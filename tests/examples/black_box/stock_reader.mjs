// What the packages that Foxglove reads with make of a merged recording of the demo.
//   node stock_reader.mjs FILE
// Run it where @mcap/core is.
import assert from 'node:assert/strict';
import fs from 'node:fs';

import {parseIDL} from '@foxglove/omgidl-parser';
import {MessageReader} from '@foxglove/omgidl-serialization';
import {McapIndexedReader} from '@mcap/core';
import {loadDecompressHandlers} from '@mcap/support';

const bytes = fs.readFileSync(process.argv[2]);
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => new Uint8Array(bytes.buffer, bytes.byteOffset + Number(offset), Number(length)),
};
const reader = await McapIndexedReader.Initialize({readable, decompressHandlers: await loadDecompressHandlers()});
const counts = new Map();
const decoders = new Map();
let last = 0n;
for await (const message of reader.readMessages()) {
  const {topic, schemaId} = reader.channelsById.get(message.channelId);
  counts.set(topic, (counts.get(topic) ?? 0) + 1);
  assert.ok(message.logTime >= last, 'on one time line');
  last = message.logTime;
  const schema = reader.schemasById.get(schemaId);
  if (schema?.name !== 'Uav::Pose') continue;
  if (!decoders.has(schemaId)) decoders.set(schemaId, new MessageReader(schema.name, parseIDL(new TextDecoder().decode(schema.data))));
  const {latitude_deg: latitude} = decoders.get(schemaId).readMessage(message.data);
  assert.ok(latitude > 47 && latitude < 48, `${latitude}`);
}
for (const uav of ['uav1', 'uav2', 'uav3']) {
  const expected = [`${uav}/Pose`, `ground/Recorder/knew/${uav}/Pose`, `${uav}/Recorder/Steps/MissionControl`,
    `${uav}.vision/Targets`];
  for (const topic of expected) assert.ok((counts.get(topic) ?? 0) >= 5, `${topic}: ${counts.get(topic)} messages`);
}
console.log(`${[...counts.values()].reduce((sum, one) => sum + one)} messages of ${counts.size} topics`);
