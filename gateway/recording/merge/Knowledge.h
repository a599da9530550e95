#pragma once

#include <rabit/mcap/ByteSource.h>
#include <rabit/mcap/McapContents.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "recording/merge/Moment.h"

namespace Rabit::Merge
{

// One recorded life (incarnation) of a node.
struct KnowerLife
{
    std::string Node;
    unsigned Number = 1;
    std::uint64_t Incarnation = 0;  // 0: not known
    Moment Begin = 0;
    Moment End = 0;
};

// A message as one life of a node knew it: of another node, or its own.
struct KnownStream
{
    std::size_t Life = 0;  // of Knowledge::Lives
    std::string Node;      // that posts it
    std::string Message;
    std::string Type;    // IDL name
    std::string Schema;  // IDL text
    std::set<std::uint16_t> Channels;
};

// The messages that nodes knew, in a merged file or in the recording of one node.
struct Knowledge
{
    explicit Knowledge(const Mcap::Contents &contents);

    std::vector<KnowerLife> Lives;
    std::vector<KnownStream> Streams;  // by knower, its life, node and message
    // The worst error of the times in the file; empty if not known, or if the file was not merged.
    std::optional<Moment> WorstBound;
};

// The last value that a node had at that moment.
struct KnownValue
{
    Moment ReceivedAt = 0;
    Moment PostedAt = 0;  // as it was estimated when it was received
    Mcap::Bytes Sample;
    std::optional<Moment> UncertainBy;  // how wrong that estimate may be; empty: not known
    std::uint64_t Incarnation = 0;      // of the life of the node that posted it; 0: not known
};

// Returns the value of a stream at a moment within the knower's life; empty if there was none yet. Parts
// that could not be read are added to `problems`, one line each.
std::optional<KnownValue> ValueAt(Mcap::ByteSource &source, const Mcap::Contents &contents,
                                  const Knowledge &knowledge, const KnownStream &stream, Moment at,
                                  std::vector<std::string> &problems);

}  // namespace Rabit::Merge
