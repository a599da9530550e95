#pragma once

#include <map>
#include <string>
#include <vector>

#include "recording/mcap/ByteSource.h"
#include "recording/mcap/McapRecords.h"

namespace Rabit::Mcap
{

// What a file holds, without the messages themselves.
struct Contents
{
    Mcap::Header Header;
    std::map<std::uint16_t, Schema> Schemas;
    std::map<std::uint16_t, Channel> Channels;
    std::vector<ChunkIndex> Chunks;  // in the order of the file; from a scan without offsets of indexes
    std::vector<AttachmentIndex> Attachments;
    std::vector<Metadata> MetadataRecords;  // in the order of the file
    Mcap::Statistics Statistics;
    // Whether the file was ended in order, and so has a summary that was used.
    bool IsIndexed = false;
    // Where the last whole record ends; the size of an indexed file.
    std::uint64_t GoodUntil = 0;
    // What of it cannot be read, one line each, printable ASCII. No more than MostProblems.
    std::vector<std::string> Problems;
    static constexpr std::size_t MostProblems = 100;

    void AddProblem(std::string problem);
    bool AddDefinition(Schema schema);
    bool AddDefinition(Channel channel);

private:
    // Of schemas, channels and metadata together; more are not taken.
    static constexpr std::size_t MostDefinitionBytes = 64U << 20;
    bool HasRoomFor(std::size_t bytes);
    std::size_t _definitionBytes = 0;
};

// From the summary, or if there is none, or none that is whole, from all of the file. Never throws on account
// of the bytes. A file that is no MCAP at all has no contents and a problem.
Contents ReadContents(ByteSource &source);
// From all of the file, whatever its summary says.
Contents ScanContents(ByteSource &source);

// What the file says under that name, the last time; empty if nothing.
TextMap MetadataOf(const Contents &contents, const std::string &name);
// The text of that key; empty if there is none.
std::string ValueOf(const TextMap &values, const std::string &key);

}  // namespace Rabit::Mcap
