#pragma once

#include "Console.h"
#include "Medium.h"
#include "PcapFile.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Rabit::Radio
{

struct RadioOptions
{
    MediumSettings Medium;
    std::vector<std::pair<std::string, std::string>> Nodes;  // name, network namespace as TapDevice takes it
    std::string Device = "eth0";
    std::string Pcap;     // path; empty: no recording
    std::string Control;  // path of a Unix socket; empty: commands come from the standard input
};

// Carries frames between TAP devices over a medium, by the clock. One thread. Ends by SIGINT, SIGTERM or,
// without Control, at the end of the standard input.
//
// The standard output begins with {"ready": true, "addresses": {name: MAC}, "realtime": bool}. The answers to
// the lines of the standard input follow. Beside the commands of Console there is:
//
//   lateness   {frames, mean_us, most_us, unwritten}: how much later than due frames were given to their
//              receivers, and how many a device did not take; since the last call
class RadioProgram
{
public:
    // Throws the exceptions of TapDevice and PcapFile.
    explicit RadioProgram(const RadioOptions &options);
    void Run();

private:
    using Stream = boost::asio::posix::stream_descriptor;
    using Local = boost::asio::local::stream_protocol;

    Time Now() const { return std::chrono::steady_clock::now() - _began; }
    void OpenControl(const std::string &path);
    void Accept();
    void Converse(Stream in, Stream out, bool endsAll);
    void Wait(std::size_t node);
    void ReadAll(std::size_t node);
    // Gives out all frames that have arrived, and sets the timer for the next ones.
    void Carry();
    void GiveOut(const Arrival &arrival);
    std::string Answer(const std::string &line);
    std::string Lateness();

    boost::asio::io_context _io{1};
    std::chrono::steady_clock::time_point _began = std::chrono::steady_clock::now();
    Medium _medium;
    Console _console{_medium};
    std::optional<PcapFile> _pcap;
    std::vector<Stream> _devices;
    std::string _addresses;
    boost::asio::steady_timer _timer{_io};
    std::optional<Time> _timerFor;
    boost::asio::signal_set _signals{_io};
    std::optional<Local::acceptor> _acceptor;
    std::string _control;
    std::vector<Arrival> _arrived;
    Frame _buffer;
    std::uint64_t _given = 0;
    std::uint64_t _unwritten = 0;
    Time _late{0};
    Time _latest{0};
};

}  // namespace Rabit::Radio
