#pragma once

#include <rabit/mcap/McapRecords.h>

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>

#include "backfill/Series.h"

namespace Rabit::Backfill
{

// False if the text is anything but such a number.
template <typename Number>
bool ReadNumber(const std::string &text, Number &number)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

// The series of a channel that SeriesStreams has written, and its clock: what is to be added to source time
// to get the publish times of its messages.
struct RecordedSeries
{
    Series Of;
    std::int64_t SourceToLog = 0;
};
// Empty: it is another channel.
std::optional<RecordedSeries> SeriesIn(const Mcap::Channel &channel);

// The stamp of a message in such a channel.
Stamp StampIn(const Mcap::Message &message, std::int64_t sourceToLog);

}  // namespace Rabit::Backfill
