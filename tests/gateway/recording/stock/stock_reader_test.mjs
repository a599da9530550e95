// Reads what stock_samples wrote with the packages that Foxglove uses.
//   node stock_reader_test.mjs CASE FOLDER
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";

import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";

import { difference, parseExact } from "./same_value.mjs";

const [name, folder] = process.argv.slice(2);
const decompressHandlers = await loadDecompressHandlers();

function read(file) {
    return fs.readFileSync(path.join(folder, file));
}

function readable(bytes) {
    return {
        size: async () => BigInt(bytes.length),
        read: async (offset, length) => new Uint8Array(bytes.buffer, bytes.byteOffset + Number(offset), Number(length)),
    };
}

function messagesOfStream(bytes) {
    const reader = new McapStreamReader({ decompressHandlers });
    reader.append(bytes);
    const messages = [];
    for (let record; (record = reader.nextRecord()) !== undefined;) {
        if (record.type === "Message") messages.push(record);
    }
    return { messages, isWhole: reader.done() };
}

// Foxglove takes a JSON schema only if each property in it has one plain type.
function checkJsonSchema(schema, path) {
    assert.equal(typeof schema.type, "string", `${path}: ${JSON.stringify(schema.type)}`);
    if (schema.type === "array") checkJsonSchema(schema.items, `${path}[]`);
    for (const [name, inner] of Object.entries(schema.properties ?? {})) checkJsonSchema(inner, `${path}.${name}`);
}

// What these packages do not read.
const NOT_READ = {
    "Constructs::Choices": "bitmasks",
    "Constructs::Collections": "sequences of sequences",
    "Constructs::Defaults": "characters as defaults",
    "Constructs::Unions": "characters that select a case",
    "Fresh::All": "arrays of sequences",
    "Growth::Grids": "arrays of sequences",
    "Growth::Rows": "sequences of sequences",
    "Limits::Extremes": "characters that select a case",
    "Shadow::Both": "names that begin with ::",
    "Words::Uses::All": "bitmasks",
};

const cases = {
    reads_a_file_that_ends_anywhere() {
        const bytes = read("small.mcap");
        const marks = JSON.parse(read("small.json"));
        const all = messagesOfStream(bytes);
        assert.ok(all.isWhole);
        assert.equal(all.messages.length, marks.at(-1)[1]);
        for (let size = 0; size < bytes.length; ++size) {
            const { messages, isWhole } = messagesOfStream(bytes.subarray(0, size));
            const least = marks.filter(([end]) => end <= size).at(-1)?.[1] ?? 0;
            assert.ok(messages.length >= least, `of ${size} bytes ${messages.length} messages are read, not ${least}`);
            assert.ok(!isWhole);
            messages.forEach((message, at) => assert.deepEqual(message, all.messages[at]));
        }
    },

    async finds_its_way_by_the_index() {
        const bytes = read("small.mcap");
        const reader = await McapIndexedReader.Initialize({ readable: readable(bytes), decompressHandlers });
        assert.equal(reader.statistics.messageCount, 12n);
        assert.deepEqual([...reader.channelsById.values()].map((channel) => channel.topic),
                         ["uav0/Health", "uav2/Health", "uav4/Health"]);
        const topics = [];
        for await (const message of reader.readMessages({ topics: ["uav2/Health"], startTime: 3000000n })) {
            topics.push(reader.channelsById.get(message.channelId).topic);
        }
        assert.deepEqual(topics, ["uav2/Health", "uav2/Health", "uav2/Health"]);
        for await (const attachment of reader.readAttachments()) assert.equal(attachment.name, "uav1.yaml");
        for await (const metadata of reader.readMetadata()) assert.equal(metadata.metadata.get("node"), "uav1");
    },

    async reads_a_merged_file() {
        const reader = await McapIndexedReader.Initialize({ readable: readable(read("merged.mcap")), decompressHandlers });
        const channels = [...reader.channelsById.values()];
        const lives = channels.filter((channel) => channel.topic === "sensor/Reading")
            .map((channel) => channel.metadata.get("rabit.life"));
        assert.deepEqual(lives.sort(), ["1", "2"]);
        const knew = channels.find((channel) => channel.topic === "display/Recorder/knew/sensor/Reading");
        assert.equal(knew.metadata.get("rabit.kind"), "knew");
        const metadata = new Map();
        for await (const record of reader.readMetadata()) metadata.set(record.name, record.metadata);
        assert.ok(Number(metadata.get("rabit.merge").get("uncertain_by_ns")) < 5e7);
        for (const { name, encoding, data } of reader.schemasById.values()) {
            if (encoding === "jsonschema") checkJsonSchema(JSON.parse(new TextDecoder().decode(data)), name);
        }
        const schema = reader.schemasById.get(knew.schemaId);
        const decoder = new MessageReader(schema.name, parseIDL(new TextDecoder().decode(schema.data)));
        let last = 0n;
        let numbers = 0;
        for await (const message of reader.readMessages()) {
            assert.ok(message.logTime >= last);
            last = message.logTime;
            if (message.channelId === knew.id) {
                assert.ok(decoder.readMessage(message.data).number > 0);
                numbers += 1;
            }
        }
        assert.ok(numbers >= 8, `${numbers} readings`);
    },

    async decodes_every_type() {
        const reader = await McapIndexedReader.Initialize({ readable: readable(read("corpus.mcap")), decompressHandlers });
        const values = read("corpus.jsonl").toString().trimEnd().split("\n");
        const readers = new Map();
        const failed = new Map();
        const fine = new Set();
        let at = 0;
        for await (const message of reader.readMessages()) {
            const schema = reader.schemasById.get(reader.channelsById.get(message.channelId).schemaId);
            const expected = parseExact(values[at++]);
            if (failed.has(schema.name)) continue;
            try {
                if (!readers.has(schema.name)) {
                    const definitions = parseIDL(new TextDecoder().decode(schema.data));
                    readers.set(schema.name, { definitions: new Map(definitions.map((one) => [one.name, one])),
                                               reader: new MessageReader(schema.name, definitions) });
                }
                const { definitions, reader: decoder } = readers.get(schema.name);
                const different = difference(expected, decoder.readMessage(message.data), { type: schema.name }, definitions);
                if (different === "") fine.add(schema.name);
                else failed.set(schema.name, different);
            } catch (error) {
                failed.set(schema.name, error.message.split("\n")[0]);
            }
        }
        assert.equal(at, values.length);
        for (const [type, reason] of failed) {
            assert.ok(type in NOT_READ, `${type} is not read: ${reason}`);
            fine.delete(type);
        }
        for (const type in NOT_READ) assert.ok(failed.has(type), `${type} is read: ${NOT_READ[type]}`);
        assert.ok(fine.size > 40, `${fine.size} types are read`);
    },
};

await cases[name]();
console.log("ok");
