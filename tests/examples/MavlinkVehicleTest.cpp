#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "mavlink/ByteChannel.h"
#include "mavlink/MavlinkVehicle.h"

namespace Swarm
{
namespace
{

using namespace std::chrono_literals;

// A channel whose other end the test plays.
class PlayedChannel : public ByteChannel
{
public:
    struct Wires
    {
        std::deque<std::uint8_t> ToVehicle;
        MavlinkParser FromVehicle;
    };
    explicit PlayedChannel(std::shared_ptr<Wires> wires) : _wires(std::move(wires)) {}

    std::size_t Receive(std::span<std::uint8_t> buffer, Time) override
    {
        const std::size_t size = std::min(buffer.size(), _wires->ToVehicle.size());
        std::copy_n(_wires->ToVehicle.begin(), size, buffer.begin());
        _wires->ToVehicle.erase(_wires->ToVehicle.begin(),
                                _wires->ToVehicle.begin() + static_cast<std::ptrdiff_t>(size));
        return size;
    }
    bool Send(std::span<const std::uint8_t> bytes) override
    {
        _wires->FromVehicle.Add(bytes);
        return true;
    }

private:
    std::shared_ptr<Wires> _wires;
};

class MavlinkVehicleTest : public ::testing::Test
{
protected:
    MavlinkVehicleTest() { vehicle.Start(now); }

    void Hear(MavlinkFrame frame, std::uint8_t system = 7)
    {
        frame.System = system;
        const auto bytes = EncodeMavlink(frame);
        wires->ToVehicle.insert(wires->ToVehicle.end(), bytes.begin(), bytes.end());
    }
    void HearHeartbeat(std::uint8_t system = 7)
    {
        Hear(MavlinkHeartbeat{.Type = 2, .Autopilot = 3}.Encode(), system);
    }
    static MavlinkFrame Position(std::int32_t latitudeE7)
    {
        return MavlinkGlobalPosition{.LatitudeE7 = latitudeE7,
                                     .LongitudeE7 = 85'456'000,
                                     .AltitudeMm = 520'500,
                                     .NorthCmps = 120,
                                     .EastCmps = -250,
                                     .DownCmps = 30}
            .Encode();
    }
    // Returns the messages sent since the last call.
    template <typename Message>
    std::vector<Message> Sent()
    {
        std::vector<Message> messages;
        while (const auto frame = wires->FromVehicle.Next())
        {
            if (const auto message = Message::Decode(*frame))
                messages.push_back(*message);
        }
        return messages;
    }
    void Run(std::chrono::milliseconds duration, bool withHeartbeats = true)
    {
        for (auto end = now + duration; now < end; now += 20ms)
        {
            if (withHeartbeats && now.count() % 1'000'000'000 == 0)
                HearHeartbeat();
            vehicle.Update(now);
        }
    }

    std::chrono::nanoseconds now = 100s;
    const std::shared_ptr<PlayedChannel::Wires> wires = std::make_shared<PlayedChannel::Wires>();
    MavlinkVehicle vehicle{std::make_unique<PlayedChannel>(wires)};
};

TEST_F(MavlinkVehicleTest, APositionIsToldOnceWithTheAttitudeBeforeIt)
{
    HearHeartbeat();
    Hear(MavlinkAttitude{.Roll = 0.25f, .Pitch = -0.5f, .Yaw = 1.5f}.Encode());
    Hear(Position(473'977'000));
    const auto motion = vehicle.Update(now);
    ASSERT_TRUE(motion);
    EXPECT_NEAR(motion->Position.LatitudeDeg, 47.3977, 1e-9);
    EXPECT_NEAR(motion->Position.LongitudeDeg, 8.5456, 1e-9);
    EXPECT_NEAR(motion->Position.AltitudeM, 520.5, 1e-9);
    EXPECT_NEAR(motion->NorthMps, 1.2, 1e-9);
    EXPECT_NEAR(motion->EastMps, -2.5, 1e-9);
    EXPECT_NEAR(motion->DownMps, 0.3, 1e-9);
    EXPECT_EQ(motion->RollRad, 0.25);
    EXPECT_EQ(motion->PitchRad, -0.5);
    EXPECT_EQ(motion->YawRad, 1.5);
    EXPECT_FALSE(vehicle.Update(now + 100ms)) << "an old position is not told again";
}

TEST_F(MavlinkVehicleTest, NothingIsToldOfASystemThatSentNoHeartbeat)
{
    Hear(Position(1));
    EXPECT_FALSE(vehicle.Update(now));
}

TEST_F(MavlinkVehicleTest, OnlyTheFirstAutopilotIsListenedTo)
{
    HearHeartbeat(7);
    HearHeartbeat(8);
    Hear(Position(1), 8);
    EXPECT_FALSE(vehicle.Update(now));
}

TEST_F(MavlinkVehicleTest, AGroundStationOnTheChannelIsNoAutopilot)
{
    Hear(MavlinkHeartbeat{.Type = 6, .Autopilot = MavlinkHeartbeat::AutopilotInvalid}.Encode());
    vehicle.Update(now);
    EXPECT_FALSE(vehicle.IsHeard(now));
}

TEST_F(MavlinkVehicleTest, ItTellsTheAutopilotOnceASecondThatItIsThere)
{
    Run(10s);
    const auto sent = Sent<MavlinkHeartbeat>();
    EXPECT_EQ(sent.size(), 10u);
    EXPECT_EQ(sent[0].Autopilot, MavlinkHeartbeat::AutopilotInvalid);
}

TEST_F(MavlinkVehicleTest, APointToFlyToIsSentTwiceASecond)
{
    Run(1s);
    Sent<MavlinkPositionTarget>();
    EXPECT_EQ(vehicle.NotReady(now), "");
    vehicle.FlyTo({47.5, -8.25, 600}, 10, now);
    Run(5s);
    const auto sent = Sent<MavlinkPositionTarget>();
    ASSERT_EQ(sent.size(), 10u);
    EXPECT_EQ(sent[0].LatitudeE7, 475'000'000);
    EXPECT_EQ(sent[0].LongitudeE7, -82'500'000);
    EXPECT_EQ(sent[0].AltitudeM, 600.0f);
    EXPECT_EQ(sent[0].TargetSystem, 7);
    EXPECT_EQ(sent[0].CoordinateFrame, MavlinkPositionTarget::FrameGlobalInt);
    EXPECT_EQ(sent[0].TypeMask, MavlinkPositionTarget::PositionOnly);
}

TEST_F(MavlinkVehicleTest, ItFliesNoCommandWhileNoAutopilotIsHeard)
{
    EXPECT_EQ(vehicle.NotReady(now), "no autopilot is heard");
    vehicle.FlyTo({47.5, 8.25, 600}, 10, now);
    EXPECT_EQ(vehicle.Phase(), Uav::FlightPhase::FLIGHT_IDLE);
    Run(1s);
    EXPECT_EQ(vehicle.NotReady(now), "");
    Run(4s, false);
    EXPECT_EQ(vehicle.NotReady(now), "no autopilot is heard");
}

TEST_F(MavlinkVehicleTest, NoPointIsSentToAnAutopilotThatIsGone)
{
    Run(1s);
    vehicle.FlyTo({47.5, 8.25, 600}, 10, now);
    Run(4s, false);
    Sent<MavlinkPositionTarget>();
    Run(5s, false);
    EXPECT_TRUE(Sent<MavlinkPositionTarget>().empty());
}

TEST_F(MavlinkVehicleTest, ItIsIdleThenOnItsWayThenHolds)
{
    Run(1s);
    EXPECT_EQ(vehicle.Phase(), Uav::FlightPhase::FLIGHT_IDLE);
    vehicle.FlyTo({47.5, 8.5456, 520.5}, 10, now);
    EXPECT_EQ(vehicle.Phase(), Uav::FlightPhase::FLIGHT_COURSE);
    Hear(Position(474'999'000));
    vehicle.Update(now);
    EXPECT_EQ(vehicle.Phase(), Uav::FlightPhase::FLIGHT_HOLD);
}

TEST(ByteChannel, AWrongDescriptionIsOneClearLine)
{
    for (const auto &[description, expected] : std::vector<std::pair<std::string, std::string>>{
             {"upd:14550", "`upd:14550` is neither udp:PORT, udp:ADDRESS:PORT nor serial:DEVICE:BAUD"},
             {"udp:99999", "udp:99999: `99999` is not a number that fits there"},
             {"udp:127.0.0.1:0", "udp:127.0.0.1:0: `0` is not a number that fits there"},
             {"udp:field:14550", "udp:field:14550: `field` is not an IP address of this machine"},
             {"udp:", "udp:: `` is not a number that fits there"},
             {"serial:/dev/none:57600", "serial:/dev/none:57600: No such file or directory"},
             {"serial:/dev/none",
              "`serial:/dev/none` is neither udp:PORT, udp:ADDRESS:PORT nor serial:DEVICE:BAUD"}})
    {
        try
        {
            OpenByteChannel(description);
            ADD_FAILURE() << description;
        }
        catch (const ChannelError &error)
        {
            EXPECT_EQ(std::string(error.what()), expected);
        }
    }
}

}  // namespace
}  // namespace Swarm
