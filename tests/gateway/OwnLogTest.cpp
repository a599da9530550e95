#include "report/OwnLog.h"

#include <gmock/gmock.h>
#include <rabit/RabitLog.h>

#include <string>
#include <vector>

#include "../core/CapturedLog.h"
#include "wire/NodeReports.h"

namespace Rabit
{
namespace
{

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class OwnLogTest : public ::testing::Test
{
protected:
    static void Say(const std::string &text) { RabitLog::Write(RabitLogLevel::Warning, text); }

    // The number of the first line, and the lines.
    static std::vector<std::string> Split(const std::string &report)
    {
        std::vector<std::string> lines;
        std::size_t begin = 0;
        for (std::size_t end = report.find('\n'); end != std::string::npos; end = report.find('\n', begin))
        {
            lines.push_back(report.substr(begin, end - begin));
            begin = end + 1;
        }
        return lines;
    }

    RabitTest::CapturedLog quiet;
    OwnLog log{"uav1 began"};
};

TEST_F(OwnLogTest, BeginsWithItsFirstLine)
{
    EXPECT_THAT(Split(log.Last(20)), ElementsAre("0", EndsWith("info uav1 began")));
}

TEST_F(OwnLogTest, GivesTheLastLinesAndTheirNumber)
{
    Say("one");
    Say("two");
    EXPECT_THAT(Split(log.Last(2)), ElementsAre("1", EndsWith("warning one"), EndsWith("warning two")));
}

TEST_F(OwnLogTest, GivesTheLinesFromANumberOnceThereAreAny)
{
    Say("one");
    EXPECT_FALSE(log.From(2).has_value());
    Say("two");
    EXPECT_THAT(Split(log.From(2).value()), ElementsAre("2", EndsWith("two")));
}

TEST_F(OwnLogTest, GivesWhatIsKeptForANumberOfAnotherLife)
{
    EXPECT_THAT(Split(log.From(12345).value()), ElementsAre("0", EndsWith("began")));
}

TEST_F(OwnLogTest, KeepsTheNewestLines)
{
    for (std::size_t i = 0; i < OwnLog::MostLines; ++i)
    {
        Say("line");
    }
    EXPECT_EQ(Split(log.From(0).value()).front(), "1");
    EXPECT_THAT(Split(log.Last(5)), SizeIs(6));
}

TEST_F(OwnLogTest, AReportIsBoundedAndTheRestFollows)
{
    for (int i = 0; i < 200; ++i)
    {
        Say(std::string(OwnLog::LongestLine + 100, 'x'));
    }
    const std::string oldest = log.From(0).value();
    EXPECT_LE(oldest.size(), NodeReports::Largest);
    EXPECT_THAT(Split(oldest).back(), AllOf(SizeIs(OwnLog::LongestLine), EndsWith("...")));
    const std::vector<std::string> last = Split(log.Last(1000));
    EXPECT_LE(log.Last(1000).size(), NodeReports::Largest);
    EXPECT_EQ(std::stoul(last[0]) + last.size() - 1, 201u) << "the newest line is in it";
}

}  // namespace
}  // namespace Rabit
