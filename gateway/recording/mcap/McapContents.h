#pragma once

#include <map>
#include <string>
#include <vector>

#include "recording/mcap/ByteSource.h"
#include "recording/mcap/McapRecords.h"

namespace Rabit::Mcap
{

// The contents of a file, without the messages themselves.
struct Contents
{
    Mcap::Header Header;
    std::map<std::uint16_t, Schema> Schemas;
    std::map<std::uint16_t, Channel> Channels;
    std::vector<ChunkIndex> Chunks;  // in the order of the file; from a scan without offsets of indexes
    std::vector<AttachmentIndex> Attachments;
    std::vector<Metadata> MetadataRecords;  // in the order of the file
    Mcap::Statistics Statistics;
    // True if the file was ended in order, and its summary was used.
    bool IsIndexed = false;
    // Where the last whole record ends; the size of an indexed file.
    std::uint64_t GoodUntil = 0;
    // The parts that cannot be read, one line each, in printable ASCII. No more than MostProblems.
    std::vector<std::string> Problems;
    static constexpr std::size_t MostProblems = 100;

    void AddProblem(std::string problem);
    bool AddDefinition(Schema schema);
    bool AddDefinition(Channel channel);
    // `recordBytes` is the size of its record in the file.
    bool AddMetadata(Metadata metadata, std::size_t recordBytes);

private:
    // Bound of schemas, channels and metadata together; more are refused. A summary may name one record any
    // number of times, so the size of the file is no bound.
    static constexpr std::size_t MostDefinitionBytes = 64U << 20;
    bool HasRoomFor(std::size_t bytes);
    std::size_t _definitionBytes = 0;
};

// Reads the contents from the summary, or from all of the file if it has no whole summary. No bytes make it
// throw. A file that is no MCAP file has no contents, and a problem.
Contents ReadContents(ByteSource &source);
// Reads the contents from all of the file, whatever its summary says.
Contents ScanContents(ByteSource &source);

// Returns the last metadata record of that name; empty if there is none.
TextMap MetadataOf(const Contents &contents, const std::string &name);
// Returns the text of that key; empty if there is none.
std::string ValueOf(const TextMap &values, const std::string &key);

}  // namespace Rabit::Mcap
