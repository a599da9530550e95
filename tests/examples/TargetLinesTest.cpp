#include "TargetLines.h"

#include <gtest/gtest.h>

namespace
{
Ground::FoundTarget Found()
{
    Ground::FoundTarget target;
    target.Aircraft = "uav1";
    target.Finding.name.aircraft = "uav1";
    target.Finding.name.number = 3;
    target.Finding.latitude_deg = 47.39771;
    target.Finding.longitude_deg = 8.5456;
    return target;
}

TEST(TargetLines, NameTheFinderAndItsNumber)
{
    EXPECT_EQ(Ground::NameOf(Found()), "uav1/3");
}

TEST(TargetLines, SayWhereATargetIs)
{
    EXPECT_EQ(Ground::TargetLine(Found()), "target uav1/3   FOUND        47.39771     8.54560");
}

TEST(TargetLines, SayWhoValidatedItAndHowLongItWasFollowed)
{
    Ground::FoundTarget target = Found();
    target.Finding.stage = Uav::TargetStage::TARGET_TRACKED;
    target.Finding.validated_by = "uav2";
    target.Finding.tracked_s = 12;
    EXPECT_EQ(Ground::TargetLine(target),
              "target uav1/3   TRACKED      47.39771     8.54560  validated by uav2, followed for 12 s");
}

TEST(TargetLines, AreAsciiWhateverTheNetworkSays)
{
    Ground::FoundTarget target = Found();
    target.Finding.validated_by = "\x1b[2Juav2";
    EXPECT_EQ(Ground::TargetLine(target).find('\x1b'), std::string::npos);
}

}  // namespace
