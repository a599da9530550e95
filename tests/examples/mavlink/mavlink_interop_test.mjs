// Our MAVLink against node-mavlink, both ways and both versions.
//
//   node mavlink_interop_test.mjs MAVLINK_PEER FOLDER_WITH_NODE_MODULES
import { strict as assert } from 'node:assert'
import { spawnSync } from 'node:child_process'
import { createRequire } from 'node:module'
import { Readable } from 'node:stream'

const [peer, folder] = process.argv.slice(2)
const mavlink = createRequire(`${folder}/package.json`)('node-mavlink')
const { MavLinkProtocolV1, MavLinkProtocolV2, MavLinkPacketParser, MavLinkPacketSplitter, common, minimal } = mavlink

const fill = (Type, fields) => Object.assign(new Type(), fields)

function ours(bytes) {
  const run = spawnSync(peer, [], { input: bytes.toString('hex'), encoding: 'utf8' })
  assert.equal(run.status, 0, run.stderr)
  return run.stdout.trim().split('\n')
}

async function theirs(bytes) {
  const packets = []
  const reader = Readable.from([bytes]).pipe(new MavLinkPacketSplitter()).pipe(new MavLinkPacketParser())
  for await (const packet of reader) packets.push(packet)
  return packets
}

// What node-mavlink sends, and the line that we must make of it.
const sent = [
  [fill(minimal.Heartbeat, { customMode: 65536, type: 2, autopilot: 3, baseMode: 209, systemStatus: 4, mavlinkVersion: 3 }),
    'HEARTBEAT 65536 2 3 209 4 3'],
  [fill(common.Attitude, { timeBootMs: 4000000000, roll: -0.5, pitch: 0.25, yaw: 3, rollspeed: 0.125, pitchspeed: -2, yawspeed: 0 }),
    'ATTITUDE 4000000000 -0.5 0.25 3 0.125 -2 0'],
  [fill(common.GlobalPositionInt, { timeBootMs: 5, lat: 473977000, lon: -1512500000, alt: -400, relativeAlt: 120000, vx: -1500, vy: 1501, vz: -3, hdg: 35999 }),
    'GLOBAL_POSITION_INT 5 473977000 -1512500000 -400 120000 -1500 1501 -3 35999'],
  [fill(common.SetPositionTargetGlobalInt, { timeBootMs: 6, targetSystem: 3, targetComponent: 1, coordinateFrame: 5, typeMask: 3576, latInt: 473977000, lonInt: 85456000, alt: 520.5, vx: 1, vy: 2, vz: 3, afx: 4, afy: 5, afz: 6, yaw: 0.5, yawRate: -0.5 }),
    'SET_POSITION_TARGET_GLOBAL_INT 6 3 1 5 3576 473977000 85456000 520.5 1 2 3 4 5 6 0.5 -0.5'],
]
let checked = 0
for (const [Protocol, version] of [[MavLinkProtocolV1, 'v1'], [MavLinkProtocolV2, 'v2']]) {
  const protocol = new Protocol(9, 8)
  for (const [message, expected] of sent) {
    assert.deepEqual(ours(protocol.serialize(message, 77)), [`${version} 77 9 8 ${expected}`])
    ++checked
  }
  const all = Buffer.concat(sent.map(([message], i) => protocol.serialize(message, i)))
  assert.equal(ours(all).length, sent.length)
  // A message that we do not know, in the middle of the others.
  const stranger = protocol.serialize(fill(common.SystemTime, { timeUnixUsec: 1n, timeBootMs: 2 }), 1)
  assert.equal(ours(Buffer.concat([all, stranger, all])).length, 2 * sent.length)
}

// What we send, and the fields that node-mavlink must find.
const expected = [
  [minimal.Heartbeat, { customMode: 7, type: 18, autopilot: 8, baseMode: 128, systemStatus: 4, mavlinkVersion: 3 }],
  [common.Attitude, { timeBootMs: 1, roll: -0.5, pitch: 0.25, yaw: 3, rollspeed: 0, pitchspeed: 0, yawspeed: 0 }],
  [common.GlobalPositionInt, { timeBootMs: 2, lat: -337500000, lon: 1512500000, alt: 520000, relativeAlt: 20000, vx: -800, vy: 801, vz: -1, hdg: 27000 }],
  [common.SetPositionTargetGlobalInt, { timeBootMs: 3, targetSystem: 1, targetComponent: 1, coordinateFrame: 5, typeMask: 3576, latInt: 473977000, lonInt: -85456000, alt: 520.5, vx: 0, yaw: 0, yawRate: 0 }],
]
const run = spawnSync(peer, ['--send'], { encoding: 'utf8' })
assert.equal(run.status, 0)
const lines = run.stdout.trim().split('\n')
assert.equal(lines.length, 2 * expected.length)
for (const [i, line] of lines.entries()) {
  const [Type, fields] = expected[i >> 1]
  const packets = await theirs(Buffer.from(line, 'hex'))
  assert.equal(packets.length, 1, `${Type.name}: not a packet for node-mavlink: ${line}`)
  const [{ header, protocol, payload }] = packets
  assert.equal(protocol.constructor.name, i % 2 === 0 ? 'MavLinkProtocolV1' : 'MavLinkProtocolV2')
  assert.deepEqual([header.seq, header.sysid, header.compid, header.msgid], [200, 12, 34, Type.MSG_ID])
  const data = protocol.data(payload, Type)
  for (const [name, value] of Object.entries(fields)) assert.equal(data[name], value, `${Type.name}.${name}`)
  ++checked
}
console.log(`${checked} messages understood`)
