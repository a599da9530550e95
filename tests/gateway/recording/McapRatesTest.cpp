// How often the messages of a channel were recorded.
#include <gtest/gtest.h>
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/McapWriter.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include "MemoryFile.h"

namespace
{

using namespace Rabit::Mcap;

std::map<std::string, std::optional<double>> RatesOf(ByteSource &file)
{
    const Contents contents = ReadContents(file);
    std::map<std::string, std::optional<double>> rates;
    for (const auto &[id, channel] : contents.Channels)
    {
        rates[channel.Topic] = RateOf(file, contents, id);
    }
    return rates;
}

TEST(McapRates, ARateIsThatFromTheFirstToTheLastMessageOfAChannelHoweverTheFileEnded)
{
    constexpr std::uint64_t second = 1'000'000'000;
    MemoryFile ended;
    McapWriter writer(ended, {"rabit test", "rabit", true});
    const auto late = *writer.AddChannel(0, "late", "json");
    const auto clock = *writer.AddChannel(0, "clock", "json");
    const Bytes data{1};
    for (std::uint64_t i = 0; i <= 20; ++i)
    {
        writer.Add({clock, 0, i * second, i * second, data});
        if (i >= 15)
        {
            writer.Add({late, 0, i * second, i * second, data});
            writer.Add({late, 0, i * second + second / 2, i * second, data});
        }
    }
    writer.FinishChunks();
    MemoryFile cutOff;
    cutOff.Content = ended.Content;
    writer.Finish();
    for (MemoryFile *file : {&ended, &cutOff})
    {
        const auto rates = RatesOf(*file);
        ASSERT_TRUE(rates.at("late") && rates.at("clock"));
        EXPECT_DOUBLE_EQ(*rates.at("late"), 2.0);
        EXPECT_DOUBLE_EQ(*rates.at("clock"), 1.0);
    }
}

TEST(McapRates, OfTwoMessagesThereIsNoRate)
{
    MemoryFile file;
    McapWriter writer(file, {"rabit test", "rabit", true});
    const auto two = *writer.AddChannel(0, "two", "json");
    const auto same = *writer.AddChannel(0, "same moment", "json");
    const Bytes data{1};
    for (std::uint64_t time = 0; time < 4; ++time)
    {
        writer.Add({time < 2 ? two : same, 0, std::min<std::uint64_t>(time, 2), 0, data});
    }
    writer.Add({same, 0, 2, 0, data});
    writer.Finish();
    EXPECT_EQ(RatesOf(file), (std::map<std::string, std::optional<double>>{{"two", std::nullopt},
                                                                           {"same moment", std::nullopt}}));
}

}  // namespace
