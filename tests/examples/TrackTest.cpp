#include "Track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <ostream>
#include <sstream>
#include <string>

namespace
{
using Swarm::Motion;
using Swarm::Track;
using Swarm::TrackError;

const std::string Header =
    "time_s,latitude_deg,longitude_deg,altitude_m,velocity_north_mps,velocity_east_mps,velocity_down_mps,"
    "roll_rad,pitch_rad,yaw_rad\n";

Track Parsed(const std::string &text)
{
    std::istringstream stream(text);
    return Track::Parse(stream, "flight.csv");
}

std::string ErrorOf(const std::string &text)
{
    try
    {
        Parsed(text);
    }
    catch (const TrackError &error)
    {
        return error.what();
    }
    return "no error";
}

TEST(Track, ReadsRowsAndStartsAtTheFirst)
{
    const Track track =
        Parsed(Header + "10,49,-123,5,1,2,-3,0.1,0.2,0.3\n12.5,49,-123,6,1,2,-3,0.1,0.2,0.3\n");
    EXPECT_EQ(track.Rows(), 2u);
    EXPECT_DOUBLE_EQ(track.DurationS(), 2.5);
    const Motion start = track.At(0);
    EXPECT_DOUBLE_EQ(start.Position.LatitudeDeg, 49);
    EXPECT_DOUBLE_EQ(start.Position.LongitudeDeg, -123);
    EXPECT_DOUBLE_EQ(start.Position.AltitudeM, 5);
    EXPECT_DOUBLE_EQ(start.NorthMps, 1);
    EXPECT_DOUBLE_EQ(start.EastMps, 2);
    EXPECT_DOUBLE_EQ(start.DownMps, -3);
    EXPECT_DOUBLE_EQ(start.RollRad, 0.1);
    EXPECT_DOUBLE_EQ(start.PitchRad, 0.2);
    EXPECT_DOUBLE_EQ(start.YawRad, 0.3);
}

TEST(Track, InterpolatesLinearlyBetweenRows)
{
    const Track track =
        Parsed(Header + "0,49,-123,0,0,0,0,0,0,0\n4,49.0004,-123.0008,8,4,-4,2,0.4,-0.4,0.8\n");
    const Motion motion = track.At(1);
    EXPECT_NEAR(motion.Position.LatitudeDeg, 49.0001, 1e-12);
    EXPECT_NEAR(motion.Position.LongitudeDeg, -123.0002, 1e-12);
    EXPECT_DOUBLE_EQ(motion.Position.AltitudeM, 2);
    EXPECT_DOUBLE_EQ(motion.NorthMps, 1);
    EXPECT_DOUBLE_EQ(motion.EastMps, -1);
    EXPECT_DOUBLE_EQ(motion.DownMps, 0.5);
    EXPECT_DOUBLE_EQ(motion.RollRad, 0.1);
    EXPECT_DOUBLE_EQ(motion.PitchRad, -0.1);
    EXPECT_DOUBLE_EQ(motion.YawRad, 0.2);
}

TEST(Track, TurnsYawTheShortWayThroughSouth)
{
    const Track track = Parsed(Header + "0,49,-123,0,0,0,0,0,0,3.1\n1,49,-123,0,0,0,0,0,0,-3.1\n");
    EXPECT_NEAR(std::abs(track.At(0.5).YawRad), std::numbers::pi, 1e-9);
}

TEST(Track, CrossesThe180thMeridianTheShortWay)
{
    const Track track = Parsed(Header + "0,0,179.9999,0,0,0,0,0,0,0\n2,0,-179.9999,0,0,0,0,0,0,0\n");
    EXPECT_NEAR(track.At(0.5).Position.LongitudeDeg, 179.99995, 1e-9);
    EXPECT_NEAR(track.At(1.5).Position.LongitudeDeg, -179.99995, 1e-9);
}

TEST(Track, FliesBackToTheStartAfterTheLastRow)
{
    // 0.0009 degrees of latitude are 100 m: 20 s at 5 m/s.
    const Track track = Parsed(Header + "0,49,-123,0,0,0,0,0,0,0\n10,49.0009,-123,0,0,0,0,0,0,0\n");
    EXPECT_NEAR(track.RoundS(), 30, 0.05);
    const Motion halfway = track.At(10 + (track.RoundS() - 10) / 2);
    EXPECT_NEAR(halfway.Position.LatitudeDeg, 49.00045, 1e-9);
    EXPECT_NEAR(halfway.NorthMps, -5, 1e-6);
    EXPECT_NEAR(track.At(track.RoundS() + 5).Position.LatitudeDeg, 49.00045, 1e-9);
}

TEST(Track, OfOneRowStaysThere)
{
    const Track track = Parsed(Header + "7,49,-123,5,0,0,0,0,0,0\n");
    EXPECT_DOUBLE_EQ(track.At(1000).Position.AltitudeM, 5);
}

TEST(Track, AcceptsCarriageReturnsSpacesAByteOrderMarkAndAMissingLastLineEnd)
{
    const std::string header = Header.substr(0, Header.size() - 1) + "\r\n";
    const std::string text = "\xEF\xBB\xBF" + header + "0, 49 ,-123,5,0,0,0,0,0,0\r\n1,49,-123,5,0,0,0,0,0,0";
    EXPECT_EQ(Parsed(text).Rows(), 2u);
}

TEST(Track, AcceptsEmptyLinesAtTheEndOnly)
{
    const std::string row = "0,49,-123,5,0,0,0,0,0,0\n";
    EXPECT_EQ(Parsed(Header + row + "\n\n").Rows(), 1u);
    EXPECT_EQ(ErrorOf(Header + "\n" + row), "flight.csv:2:1: expected a row, found an empty line");
}

struct BadText
{
    std::string Name;
    std::string Text;
    std::string Error;
};

void PrintTo(const BadText &bad, std::ostream *out)
{
    *out << bad.Name;
}

class BadTrack : public testing::TestWithParam<BadText>
{
};

TEST_P(BadTrack, IsRefusedWithFileLineColumnAndWhatWasExpected)
{
    EXPECT_EQ(ErrorOf(GetParam().Text), "flight.csv:" + GetParam().Error);
}

INSTANTIATE_TEST_SUITE_P(
    Track, BadTrack,
    testing::Values(BadText{"EmptyFile", "", "1:1: expected the line of column names, found an empty file"},
                    BadText{"NoRow", Header, "2:1: expected at least one row after the column names"},
                    BadText{"WrongColumnName", "time_s,lat,longitude_deg\n",
                            "1:8: expected the column name latitude_deg, found 'lat'"},
                    BadText{"TooFewColumnNames", "time_s,latitude_deg\n",
                            "1:20: expected the column name longitude_deg, found ''"},
                    BadText{"TooManyColumnNames", Header.substr(0, Header.size() - 1) + ",battery\n",
                            "1:127: expected the end of the line after 10 columns"},
                    BadText{"TooFewColumns", Header + "0,49,-123,5,0,0,0,0,0\n",
                            "2:22: expected 10 columns separated by commas, found 9"},
                    BadText{"TooManyColumns", Header + "0,49,-123,5,0,0,0,0,0,0,7\n",
                            "2:24: expected the end of the line after 10 columns"},
                    BadText{"NotANumber", Header + "0,49,-123,5,0,0,0,0,0,0\n1,49,north,5,0,0,0,0,0,0\n",
                            "3:6: expected a number for longitude_deg, found 'north'"},
                    BadText{"NumberWithATail", Header + "0,49,-123,5m,0,0,0,0,0,0\n",
                            "2:11: expected a number for altitude_m, found '5m'"},
                    BadText{"EmptyField", Header + "0,49,-123,,0,0,0,0,0,0\n",
                            "2:11: expected a number for altitude_m, found ''"},
                    BadText{"NotFinite", Header + "0,49,-123,5,nan,0,0,0,0,0\n",
                            "2:13: expected a number for velocity_north_mps, found 'nan'"},
                    BadText{"TooLargeForADouble", Header + "0,49,-123,1e999,0,0,0,0,0,0\n",
                            "2:11: expected a number for altitude_m, found '1e999'"},
                    BadText{"Latitude", Header + "0,90.5,-123,5,0,0,0,0,0,0\n",
                            "2:3: expected latitude_deg between -90 and 90, found '90.5'"},
                    BadText{"Longitude", Header + "0,49,-180.01,5,0,0,0,0,0,0\n",
                            "2:6: expected longitude_deg between -180 and 180, found '-180.01'"},
                    BadText{"SameTime", Header + "1,49,-123,5,0,0,0,0,0,0\n1,49,-123,5,0,0,0,0,0,0\n",
                            "3:1: expected time_s greater than 1 of the row before, found '1'"},
                    BadText{"EarlierTime", Header + "1.5,49,-123,5,0,0,0,0,0,0\n1.25,49,-123,5,0,0,0,0,0,0\n",
                            "3:1: expected time_s greater than 1.5 of the row before, found '1.25'"},
                    BadText{"BinaryText", Header + "\x01\xff,49,-123,5,0,0,0,0,0,0\n",
                            "2:1: expected a number for time_s, found '\?\?'"}),
    [](const testing::TestParamInfo<BadText> &test) { return test.param.Name; });

std::string LoadErrorOf(const std::string &path)
{
    try
    {
        Track::Load(path);
    }
    catch (const TrackError &error)
    {
        return error.what();
    }
    return "no error";
}

class TrackFile : public testing::Test
{
protected:
    // ctest runs each test case as a process of its own: the name must differ between them.
    const std::filesystem::path _folder =
        std::filesystem::temp_directory_path() /
        (std::string("rabit_track_") + testing::UnitTest::GetInstance()->current_test_info()->name());

    void SetUp() override { std::filesystem::create_directories(_folder); }
    void TearDown() override { std::filesystem::remove_all(_folder); }
};

TEST_F(TrackFile, IsLoaded)
{
    const std::string path = _folder / "flight.csv";
    std::ofstream(path) << Header << "0,49,-123,5,0,0,0,0,0,0\n";
    EXPECT_EQ(Track::Load(path).Rows(), 1u);
}

TEST_F(TrackFile, ErrorsNameItsPath)
{
    const std::string path = _folder / "flight.csv";
    std::ofstream(path) << Header << "x\n";
    EXPECT_THAT(LoadErrorOf(path), testing::StartsWith(path + ":2:"));
}

TEST_F(TrackFile, ThatIsMissingIsAnError)
{
    const std::string path = _folder / "none.csv";
    EXPECT_EQ(LoadErrorOf(path), path + ": cannot be read: no such file");
}

TEST_F(TrackFile, ThatIsAFolderIsAnError)
{
    EXPECT_EQ(LoadErrorOf(_folder), _folder.string() + ": cannot be read: it is not a regular file");
}

}  // namespace
