#pragma once

#include <rabit/mcap/ByteSource.h>
#include <rabit/mcap/McapRecords.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Rabit::Mcap
{

// Bounds of the memory that Contents takes, in bytes. Further records are left out. The size of the file is
// no bound: a summary may name one record any number of times, and indexes take more memory than bytes.
struct ContentsLimits
{
    std::size_t Definitions = 64U << 20;  // schemas, channels and metadata together
    // Chunks and attachments together. The chunks of a recording of 40 GB with 100 channels take as much.
    std::size_t Indexes = 256U << 20;
};

// The contents of a file, without the messages themselves. It holds no reference to the file.
struct Contents
{
    Contents() = default;
    explicit Contents(const ContentsLimits &limits) : _limits(limits) {}

    Mcap::Header Header;
    std::map<std::uint16_t, Schema> Schemas;
    std::map<std::uint16_t, Channel> Channels;
    std::vector<ChunkIndex> Chunks;  // in the order of the file; from a scan without offsets of indexes
    std::vector<AttachmentIndex> Attachments;
    std::vector<Metadata> MetadataRecords;  // in the order of the file
    Mcap::Statistics Statistics;
    // Of each channel the log times of its first and last message; empty if they were read from the summary.
    std::map<std::uint16_t, std::pair<std::uint64_t, std::uint64_t>> Spans;
    // True if the file was ended in order, and its summary was used.
    bool IsIndexed = false;
    // Where the last whole record ends; the size of an indexed file.
    std::uint64_t GoodUntil = 0;
    // The parts that cannot be read, one line each, in printable ASCII. No more than MostProblems.
    std::vector<std::string> Problems;
    static constexpr std::size_t MostProblems = 100;

    void AddProblem(std::string problem);
    // These return false beyond the limits.
    bool Add(Schema schema);
    bool Add(Channel channel);
    bool Add(Metadata metadata);
    bool Add(ChunkIndex chunk);
    bool Add(AttachmentIndex attachment);

private:
    ContentsLimits _limits;  // what is left of them
};

// Reads the contents from the summary, or from all of the file if it has no whole summary. These functions
// keep no state: several threads may read different sources. No bytes make them throw. A file that is no MCAP
// file has no contents, and a problem.
Contents ReadContents(ByteSource &source, const ContentsLimits &limits = {});
// Reads the contents from all of the file, whatever its summary says.
Contents ScanContents(ByteSource &source, const ContentsLimits &limits = {});

// Returns how many messages of a channel were recorded in a second, from its first message to its last.
// Nothing for less than three messages, or if an ended file has no index of them.
std::optional<double> RateOf(ByteSource &source, const Contents &contents, std::uint16_t channel);

// True if the file begins as an MCAP file.
bool IsRecording(ByteSource &source);

// Returns the last metadata record of that name; empty if there is none.
TextMap MetadataOf(const Contents &contents, const std::string &name);
// Returns the text of that key; empty if there is none.
std::string ValueOf(const TextMap &values, const std::string &key);

}  // namespace Rabit::Mcap
