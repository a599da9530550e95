// The lab's emulated radio and the simulation have a medium each. With the same packets, the same is on the
// air at the same time, and losses are as many and as long: so a replay in simulated time is true to the
// emulated radio.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <ostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lab/radio/Medium.h"
#include "simulated/src/FaultPlan.h"
#include "simulated/src/Medium.h"
#include "simulated/src/Random.h"

namespace
{

using namespace std::chrono_literals;
using Time = std::chrono::nanoseconds;

constexpr std::size_t Nodes = 3;

struct Offered
{
    Time At;
    std::uint32_t Node;
    std::size_t Bytes;
};

// A packet that has passed the medium.
struct Passed
{
    std::size_t Number;
    Time At;
    // The two media round the time on the air of each packet to another side.
    bool operator==(const Passed &other) const
    {
        return Number == other.Number && std::chrono::abs(At - other.At) <= 1us;
    }
    friend std::ostream &operator<<(std::ostream &out, const Passed &passed)
    {
        return out << passed.Number << " at " << passed.At.count() << " ns";
    }
};

// Frames of all nodes, now more and now fewer than the medium carries.
std::vector<Offered> Traffic(std::uint64_t bytesPerSecond)
{
    std::mt19937_64 random(5);
    std::vector<Offered> traffic;
    Time at{0};
    for (int i = 0; i < 900; ++i)
    {
        const std::size_t bytes = 60 + random() % 1340;
        const auto onAir = static_cast<std::int64_t>(bytes * 1'000'000'000 / bytesPerSecond);
        at += 1ns + Time(static_cast<std::int64_t>(random() % 1000) * onAir / (i % 300 < 200 ? 1000 : 300));
        traffic.push_back({at, static_cast<std::uint32_t>(random() % Nodes), bytes});
    }
    return traffic;
}

Rabit::Radio::MacAddress AddressOf(std::size_t node)
{
    return {2, 0, 0, 0, 0, static_cast<std::uint8_t>(node)};
}

Rabit::Radio::FramePointer FrameOf(std::size_t number, std::size_t bytes, std::size_t to)
{
    Rabit::Radio::Frame frame(bytes);
    const auto address = AddressOf(to);
    std::copy(address.begin(), address.end(), frame.begin());
    frame[20] = static_cast<std::uint8_t>(number);
    frame[21] = static_cast<std::uint8_t>(number >> 8);
    return std::make_shared<const Rabit::Radio::Frame>(std::move(frame));
}

void AddNodes(Rabit::Radio::Medium &medium)
{
    for (std::size_t node = 0; node < Nodes; ++node)
    {
        medium.Add(std::string("n").append(std::to_string(node)), AddressOf(node));
    }
}

std::vector<Passed> OverTheEmulatedRadio(const std::vector<Offered> &traffic, std::uint64_t bytesPerSecond)
{
    Rabit::Radio::Medium medium({.BitsPerSecond = static_cast<std::int64_t>(8 * bytesPerSecond)});
    AddNodes(medium);
    std::vector<Passed> passed;
    medium.SetTap(
        [&passed](Time at, const Rabit::Radio::Frame &frame) {
            passed.push_back({frame[20] + 256u * frame[21], at});
        });
    for (std::size_t number = 0; number < traffic.size(); ++number)
    {
        const Offered &offered = traffic[number];
        medium.Offer(offered.At, offered.Node, FrameOf(number, offered.Bytes, (offered.Node + 1) % Nodes));
    }
    std::vector<Rabit::Radio::Arrival> arrived;
    medium.Advance(traffic.back().At + 1h, arrived);
    return passed;
}

std::vector<Passed> OverTheSimulatedMedium(const std::vector<Offered> &traffic, std::uint64_t bytesPerSecond)
{
    Rabit::Simulated::Medium medium;
    medium.Set({.BytesPerSecond = bytesPerSecond});
    std::vector<Passed> passed;
    const auto pass = [&](Time until)
    {
        for (auto next = medium.Passes(); next && *next <= until; next = medium.Passes())
        {
            const Rabit::Simulated::Packet packet = medium.Pass(*next);
            const auto offered =
                std::ranges::find_if(traffic, [&packet](const Offered &one)
                                     { return one.At == packet.At && one.Node == packet.Node; });
            passed.push_back({static_cast<std::size_t>(offered - traffic.begin()), *next});
        }
    };
    for (const Offered &offered : traffic)
    {
        pass(offered.At);
        medium.Offer({.Node = offered.Node, .Bytes = offered.Bytes, .Content = nullptr}, offered.At);
    }
    pass(traffic.back().At + 1h);
    return passed;
}

// The share of packets that are lost, and how many are lost in a row on average.
struct Losses
{
    explicit Losses(const std::vector<bool> &lost)
    {
        std::size_t count = 0;
        std::size_t rows = 0;
        for (std::size_t i = 0; i < lost.size(); ++i)
        {
            count += lost[i];
            rows += lost[i] && (i == 0 || !lost[i - 1]);
        }
        Share = static_cast<double>(count) / static_cast<double>(lost.size());
        InARow = static_cast<double>(count) / static_cast<double>(rows);
    }
    double Share = 0;
    double InARow = 0;
};

constexpr std::size_t Packets = 100'000;

Losses OfTheEmulatedRadio(double loss, double burst)
{
    Rabit::Radio::Medium medium({});
    AddNodes(medium);
    medium.SetLink(0s, 0, 1, {.Loss = loss, .Burst = burst});
    std::vector<bool> lost;
    for (std::size_t i = 0; i < Packets; ++i)
    {
        std::vector<Rabit::Radio::Arrival> arrived;
        medium.Offer(Time(i), 0, FrameOf(0, 60, 1));
        medium.Advance(Time(i), arrived);
        lost.push_back(arrived.empty());
    }
    return Losses(lost);
}

Losses OfTheSimulation(double loss, double burst)
{
    Rabit::Simulated::FaultPlan plan;
    Rabit::Simulated::Random random(1);
    plan.Set("*", "*", {.Loss = loss, .Burst = burst});
    const std::uint32_t from = plan.NumberOf("from");
    const std::uint32_t to = plan.NumberOf("to");
    std::vector<bool> lost;
    for (std::size_t i = 0; i < Packets; ++i)
    {
        lost.push_back(plan.Loses(from, to, random));
    }
    return Losses(lost);
}

class TwoMediaTest : public testing::TestWithParam<std::uint64_t>
{
};

TEST_P(TwoMediaTest, TheSamePacketsPassInTheSameOrderAtTheSameTime)
{
    const std::vector<Offered> traffic = Traffic(GetParam());
    const std::vector<Passed> passed = OverTheEmulatedRadio(traffic, GetParam());
    EXPECT_LT(passed.size(), traffic.size()) << "no queue was full";
    EXPECT_EQ(OverTheSimulatedMedium(traffic, GetParam()), passed);
}

INSTANTIATE_TEST_SUITE_P(BytesPerSecond, TwoMediaTest, testing::Values(7200, 14400, 15625, 250'000));

TEST(TwoMedia, LoseAsManyInRowsAsLong)
{
    for (const auto &[loss, burst] : {std::pair(0.05, 1.0), std::pair(0.1, 4.0)})
    {
        const Losses emulated = OfTheEmulatedRadio(loss, burst);
        const Losses simulated = OfTheSimulation(loss, burst);
        EXPECT_NEAR(emulated.Share, loss, 0.1 * loss);
        EXPECT_NEAR(simulated.Share, emulated.Share, 0.1 * loss);
        EXPECT_NEAR(emulated.InARow, burst, 0.1 * burst);
        EXPECT_NEAR(simulated.InARow, emulated.InARow, 0.1 * burst);
    }
}

}  // namespace
