// Recordings, for Python.
#pragma once

#include <rabit/mcap/FileSource.h>
#include <rabit/mcap/MessageCursor.h>

#include <pybind11/pybind11.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "Codec.h"

namespace Rabit::Python
{

// One MCAP file. All functions need the GIL.
class Recording : public std::enable_shared_from_this<Recording>
{
public:
    // Throws std::runtime_error for a file that cannot be read, or is none.
    explicit Recording(const std::string &path);

    const Mcap::Contents &Contents() const { return _contents; }
    // The class of a channel's messages; null: they are JSON, or of no known encoding (`why` tells).
    std::shared_ptr<MessageClass> ClassOfChannel(std::uint16_t channel, std::string &why);

    // The messages of some channels in the order of their log times (nanoseconds since 1970), decoded as
    // they are asked for.
    class Messages
    {
    public:
        Messages(std::shared_ptr<Recording> recording, std::set<std::uint16_t> channels, std::uint64_t from,
                 std::uint64_t to);
        // Topic, log time, publish time, value. JSON is a str; a message that cannot be decoded is skipped
        // and counted. Raises StopIteration.
        py::tuple Next();
        const std::vector<std::string> &Problems() const { return _cursor.Problems(); }
        // The messages that were skipped, by the reason, which begins with the topic.
        const std::map<std::string, std::uint64_t> &Undecoded() const { return _undecoded; }

    private:
        // The value of a message; null, with the reason, if it cannot be decoded.
        py::object ValueOf(const Mcap::Message &message, const Mcap::Channel &channel, std::string &why);

        const std::shared_ptr<Recording> _recording;
        Mcap::MessageCursor _cursor;
        std::map<std::string, std::uint64_t> _undecoded;
    };

private:
    Mcap::FileSource _file;
    const Mcap::Contents _contents;
    std::map<std::uint16_t, std::pair<std::shared_ptr<MessageClass>, std::string>> _classes;
};

// Writes the recordings of several nodes into one file, on one time line. Returns remarks for people. Throws
// std::runtime_error if they cannot be merged.
std::vector<std::string> MergeRecordings(const std::vector<std::string> &files, const std::string &to,
                                         const std::string &reference, bool takesWallClocks);

}  // namespace Rabit::Python
