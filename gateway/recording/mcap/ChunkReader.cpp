#include <rabit/mcap/ChunkReader.h>

#include "recording/mcap/Crc32.h"
#include "recording/mcap/Zstd.h"

namespace Rabit::Mcap
{

std::string OpenChunk(const Chunk &chunk, Bytes &room, ByteView &records)
{
    records = {};
    if (chunk.UncompressedSize > LargestChunk)
    {
        return "it says that it is larger than 256 MiB";
    }
    if (chunk.Compression.empty())
    {
        records = chunk.Records;
    }
    else if (chunk.Compression != "zstd")
    {
        return "it is compressed in a way that is not known here";
    }
    else if (DecompressZstd(chunk.Records, chunk.UncompressedSize, room))
    {
        records = room;
    }
    else
    {
        return "it cannot be decompressed";
    }
    if (records.size() != chunk.UncompressedSize)
    {
        return "its size is wrong";
    }
    if (chunk.UncompressedCrc != 0 && chunk.UncompressedCrc != Crc32(records))
    {
        return "its checksum is wrong";
    }
    return {};
}

}  // namespace Rabit::Mcap
