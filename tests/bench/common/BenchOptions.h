#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace Rabit::Bench
{

// How the samples of a run are carried.
enum class Carriage
{
    State,      // mirrored message: reliable, transient-local, the newest value counts
    Telemetry,  // mirrored message: best effort, volatile
    Queue       // each and every message
};

// The options that all measured programs share, so that a driver can replace one program by another.
struct BenchOptions
{
    // ping, pong: round trips. source, sink: as fast as it goes in one direction. announce, join: how long it
    // takes to hear of each other. member: one of a fleet. Programs may know more roles.
    std::string Role;
    Carriage How = Carriage::State;
    int Domain = 0;
    // Serialized bytes of a message, without the encapsulation header.
    std::size_t Payload = 100;
    // Number of messages before the measured ones, and of measured ones.
    std::uint64_t WarmUp = 1000;
    std::uint64_t Count = 10000;
    // Nanoseconds between two messages of a paced source; 0: as fast as it goes.
    std::int64_t Period = 0;
    // CLOCK_MONOTONIC when the process was started, in nanoseconds.
    std::int64_t SpawnedAt = 0;
    // In a fleet: the number of this member, from 1, and the number of members.
    std::size_t Member = 1;
    std::size_t Members = 2;
    // A plain program only: answer in the vendor's listener itself, without a thread of the application.
    bool InListener = false;
    // A plain program only: write on a separate thread, so that the sender never waits for the network.
    bool WriterThread = false;
    // A node only: the backend.
    std::string Transport = "fastdds";
    // The address of the network interface, and the largest datagram that DDS may make of a message.
    std::string Interface = "127.0.0.1";
    std::size_t Datagram = 65000;

    std::uint64_t Last() const { return WarmUp + Count; }
    std::size_t Padding() const;
};

// Serialized bytes of Bench::Sample apart from its padding.
inline constexpr std::size_t SampleOverhead = 20;

// Parses the command line; ends the process on --help and on errors.
BenchOptions ParseOptions(int argc, char **argv, const char *description);

}  // namespace Rabit::Bench
