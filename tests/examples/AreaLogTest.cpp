#include "AreaLog.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace
{
using testing::ElementsAre;

class AreaLog : public testing::Test
{
protected:
    Ground::AreaLog _log;

    void Give(std::uint32_t number, double nowS)
    {
        Uav::SearchArea area;
        area.number = number;
        area.north_m = 400;
        _log.Given(area, nowS);
    }
    // The answers for the area, oldest first, as `NODE PROGRESS REASON`.
    std::vector<std::string> AnswersFor(std::size_t index) const
    {
        std::vector<std::string> texts;
        for (const Ground::AreaAnswer &answer : _log.Areas().at(index).answers)
            texts.push_back(answer.node + " " + ToString(answer.progress) +
                            (answer.reason.empty() ? "" : " " + answer.reason));
        return texts;
    }
};

TEST_F(AreaLog, ListsAnAreaWithItsNumbersBeforeAnyAircraftAnswers)
{
    Give(2, 10);
    ASSERT_EQ(_log.Areas().size(), 1u);
    EXPECT_EQ(_log.Areas()[0].area.number, 2u);
    EXPECT_EQ(_log.Areas()[0].area.north_m, 400);
    EXPECT_EQ(_log.Areas()[0].given_s, 10);
    _log.Look({{"uav1", false, 1, "", 10}});
    EXPECT_THAT(AnswersFor(0), ElementsAre("uav1 AREA_SENT"));
}

TEST_F(AreaLog, TellsWhoFliesItAndWhoDeclinesItAndWhy)
{
    _log.Look({{"uav1", false, 1, "", 9}, {"uav2", false, 1, "", 9}});
    Give(2, 10);
    _log.Look({{"uav1", false, 2, "", 10.2}, {"uav2", false, 1, "60 m outside of the geofence", 10.2}});
    EXPECT_THAT(AnswersFor(0),
                ElementsAre("uav1 AREA_FLOWN", "uav2 AREA_DECLINED 60 m outside of the geofence"));
    EXPECT_EQ(_log.Areas()[0].answers[1].flies, 1u);
}

TEST_F(AreaLog, TakesNoReasonOfTheAreaBeforeForOneOfTheWantedArea)
{
    _log.Look({{"uav1", false, 1, "too low", 9}});
    Give(3, 10);
    EXPECT_THAT(AnswersFor(0), ElementsAre("uav1 AREA_SENT"));
    _log.Look({{"uav1", false, 1, "too low", 10 + Ground::AreaLog::HeardAfterS - 0.1}});
    EXPECT_THAT(AnswersFor(0), ElementsAre("uav1 AREA_SENT"));
    _log.Look({{"uav1", false, 1, "too low", 10 + Ground::AreaLog::HeardAfterS}});
    EXPECT_THAT(AnswersFor(0), ElementsAre("uav1 AREA_DECLINED too low")) << "it has heard the area by now";
}

TEST_F(AreaLog, TakesNoReasonOfAnAircraftThatIsHeardAnewForOneOfTheWantedArea)
{
    Give(3, 10);
    _log.Look({{"uav1", false, 1, "too low", 10.1}});
    EXPECT_THAT(AnswersFor(0), ElementsAre("uav1 AREA_SENT"));
}

TEST_F(AreaLog, TellsThatALostAircraftHasNotAnswered)
{
    Give(2, 10);
    _log.Look({{"uav1", true, 1, "", 5}});
    EXPECT_THAT(AnswersFor(0), ElementsAre("uav1 AREA_SENT it is LOST"));
}

TEST_F(AreaLog, TellsOfEarlierAreasWhoStillFliesThem)
{
    Give(1, 5);
    Give(2, 10);
    _log.Look({{"uav1", false, 2, "", 20}, {"uav2", false, 1, "too low", 20}});
    EXPECT_THAT(AnswersFor(0), ElementsAre("uav1 AREA_REPLACED", "uav2 AREA_FLOWN"));
    EXPECT_THAT(AnswersFor(1), ElementsAre("uav1 AREA_FLOWN", "uav2 AREA_DECLINED too low"));
}

TEST_F(AreaLog, TellsThatAnAircraftHasANewerAreaOfAnotherGroundStation)
{
    Give(2, 10);
    _log.Look({{"uav1", false, 7, "", 20}});
    EXPECT_THAT(AnswersFor(0), ElementsAre("uav1 AREA_REPLACED"));
    EXPECT_EQ(_log.Areas()[0].answers[0].flies, 7u);
}

TEST_F(AreaLog, IsBounded)
{
    for (std::uint32_t number = 1; number <= 100; ++number)
        Give(number, number);
    EXPECT_EQ(_log.Areas().size(), Ground::AreaLog::MaxListed);
    EXPECT_EQ(_log.Areas().back().area.number, 100u);
}

}  // namespace
