// A viewer that subscribes to topics, and tells what it sees, a line each.
//   node viewer.mjs URL TOPIC...
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";

const { FoxgloveClient } = protocol;
const [url, ...topics] = process.argv.slice(2);
const say = (...words) => console.log(words.join(" "));
const client = new FoxgloveClient({ ws: new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
const subscribed = new Map();

function readerOf(channel) {
    if (channel.encoding === "json") return (data) => JSON.parse(new TextDecoder().decode(data));
    const reader = new MessageReader(channel.schemaName, parseIDL(channel.schema));
    return (data) => reader.readMessage(data);
}

client.on("serverInfo", (info) => say("server", info.name));
client.on("status", (status) => say("status", status.message));
client.on("advertise", (channels) => {
    for (const channel of channels) {
        say("channel", channel.id, channel.topic, channel.encoding, channel.schemaName);
        if (topics.includes(channel.topic)) {
            subscribed.set(client.subscribe(channel.id), { channel, read: readerOf(channel) });
        }
    }
});
client.on("unadvertise", (ids) => say("gone", ids));
client.on("message", ({ subscriptionId, timestamp, data }) => {
    const { channel, read } = subscribed.get(subscriptionId);
    const value = read(new DataView(data.buffer, data.byteOffset, data.byteLength));
    const exact = (_, part) => (typeof part === "bigint" ? String(part) : part);
    say("value", channel.topic, String(timestamp), JSON.stringify(value, exact));
});
client.on("error", (error) => say("error", error.message));
client.on("close", () => process.exit(1));
