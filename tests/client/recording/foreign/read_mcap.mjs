// Reads an MCAP file by @mcap/core: node read_mcap.mjs FILE
//
// Prints a JSON line a message, {"topic", "timeNs", "schema", "data"}, in order of time. Ends with 1 where the
// file has no index, a message is no JSON, or the statistics count other than what is there.
import { createRequire } from "node:module";
import { open } from "node:fs/promises";

const require = createRequire(import.meta.url);
const { McapIndexedReader } = require("@mcap/core");
const zstd = require("@foxglove/wasm-zstd");

const file = await open(process.argv[2], "r");
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, length) => {
    const buffer = new Uint8Array(Number(length));
    const { bytesRead } = await file.read(buffer, 0, Number(length), Number(offset));
    return buffer.subarray(0, bytesRead);
  },
};
await zstd.isLoaded;
const reader = await McapIndexedReader.Initialize({
  readable,
  decompressHandlers: { zstd: (data, size) => zstd.decompress(data, Number(size)) },
});
if (reader.chunkIndexes.length === 0) throw new Error("no chunk is indexed");
let messages = 0n;
const lines = [];
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  if (schema.encoding !== "jsonschema") throw new Error(`${channel.topic}: ${schema.encoding}`);
  JSON.parse(Buffer.from(schema.data).toString());
  lines.push(JSON.stringify({ topic: channel.topic, timeNs: message.logTime.toString(),
    schema: schema.name, data: JSON.parse(Buffer.from(message.data).toString()) }));
  ++messages;
}
if (reader.statistics.messageCount !== messages) throw new Error("statistics count otherwise");
await file.close();
process.stdout.write(lines.join("\n") + "\n");
