// The cost of turning a sample of Uav::Pose into JSON without generated code, beside generated code with
// the members written by hand. Both give the same text.
#include <rabit/dynamic/DynamicType.h>

#include <benchmark/benchmark.h>

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "uav.idl.h"

namespace
{

Uav::Pose SomePose()
{
    Uav::Pose pose;
    pose.latitude_deg = 47.123456789012;
    pose.longitude_deg = 8.987654321098;
    pose.altitude_m = 512.34567;
    pose.velocity_north_mps = 12.345F;
    pose.velocity_east_mps = -3.21F;
    pose.velocity_down_mps = 0.125F;
    pose.roll_rad = 0.0123F;
    pose.pitch_rad = -0.0456F;
    pose.yaw_rad = 3.1401F;
    pose.gps_time_s = 1447871234.567891;
    pose.number = 123456;
    return pose;
}

std::vector<std::uint8_t> Sample()
{
    const Uav::Pose pose = SomePose();
    std::vector<std::uint8_t> sample(Uav::Pose::IdlType().SerializedSize(pose));
    Uav::Pose::IdlType().Serialize(pose, sample);
    return sample;
}

template <class T>
void Add(std::string &json, const char *name, T value)
{
    char digits[32];
    json += name;
    json.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

std::string ByHand(const Uav::Pose &pose)
{
    std::string json;
    json.reserve(512);
    Add(json, "{\"latitude_deg\":", pose.latitude_deg);
    Add(json, ",\"longitude_deg\":", pose.longitude_deg);
    Add(json, ",\"altitude_m\":", pose.altitude_m);
    Add(json, ",\"velocity_north_mps\":", pose.velocity_north_mps);
    Add(json, ",\"velocity_east_mps\":", pose.velocity_east_mps);
    Add(json, ",\"velocity_down_mps\":", pose.velocity_down_mps);
    Add(json, ",\"roll_rad\":", pose.roll_rad);
    Add(json, ",\"pitch_rad\":", pose.pitch_rad);
    Add(json, ",\"yaw_rad\":", pose.yaw_rad);
    Add(json, ",\"gps_time_s\":", pose.gps_time_s);
    Add(json, ",\"number\":", pose.number);
    json += '}';
    return json;
}

const Rabit::DynamicType &Dynamic()
{
    static const auto type =
        Rabit::DynamicType::Parse(Uav::Pose::IdlType().IdlText(), Uav::Pose::IdlType().Name()).Type;
    return *type;
}

void GeneratedByHand(benchmark::State &state)
{
    const std::vector<std::uint8_t> sample = Sample();
    Uav::Pose pose;
    for (auto _ : state)
    {
        Uav::Pose::IdlType().Deserialize(sample, pose);
        benchmark::DoNotOptimize(ByHand(pose));
    }
}
BENCHMARK(GeneratedByHand)->Name("PoseToJson/GeneratedCodeAndByHand");

void GeneratedWithLibrary(benchmark::State &state)
{
    const std::vector<std::uint8_t> sample = Sample();
    Uav::Pose pose;
    for (auto _ : state)
    {
        Uav::Pose::IdlType().Deserialize(sample, pose);
        nlohmann::ordered_json json{{"latitude_deg", pose.latitude_deg},
                                    {"longitude_deg", pose.longitude_deg},
                                    {"altitude_m", pose.altitude_m},
                                    {"velocity_north_mps", pose.velocity_north_mps},
                                    {"velocity_east_mps", pose.velocity_east_mps},
                                    {"velocity_down_mps", pose.velocity_down_mps},
                                    {"roll_rad", pose.roll_rad},
                                    {"pitch_rad", pose.pitch_rad},
                                    {"yaw_rad", pose.yaw_rad},
                                    {"gps_time_s", pose.gps_time_s},
                                    {"number", pose.number}};
        benchmark::DoNotOptimize(json.dump());
    }
}
BENCHMARK(GeneratedWithLibrary)->Name("PoseToJson/GeneratedCodeAndNlohmann");

void DynamicToJson(benchmark::State &state)
{
    const std::vector<std::uint8_t> sample = Sample();
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(Dynamic().ToJson(sample));
    }
}
BENCHMARK(DynamicToJson)->Name("PoseToJson/Dynamic");

void DynamicFromJson(benchmark::State &state)
{
    const std::string json = ByHand(SomePose());
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(Dynamic().FromJson(json));
    }
}
BENCHMARK(DynamicFromJson)->Name("PoseFromJson/Dynamic");

void ParseText(benchmark::State &state)
{
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(
            Rabit::DynamicType::Parse(Uav::Pose::IdlType().IdlText(), Uav::Pose::IdlType().Name()));
    }
}
BENCHMARK(ParseText)->Name("PoseFromIdlText");

}  // namespace

int main(int argc, char **argv)
{
    if (Dynamic().ToJson(Sample()) != ByHand(SomePose()))
    {
        std::cerr << "the contestants do not do the same\n";
        return EXIT_FAILURE;
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv))
    {
        return 2;
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return EXIT_SUCCESS;
}
