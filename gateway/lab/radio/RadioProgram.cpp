#include "RadioProgram.h"

#include "ControlSession.h"
#include "TapDevice.h"

#include <boost/asio/post.hpp>
#include <nlohmann/json.hpp>

#include <sched.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <system_error>
#include <utility>

namespace Rabit::Radio
{
namespace
{

constexpr std::size_t LargestFrame = 65'536;
// Number of frames of one node that are read before the others get their turn.
constexpr int Batch = 32;

// Makes this process run before all others on the machine; otherwise the processors' queues would be
// measured instead of the air's. Returns false if that is not allowed.
bool BecomeRealtime()
{
    prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0);
    sched_param first{};
    first.sched_priority = 1;
    return sched_setscheduler(0, SCHED_RR, &first) == 0;
}

std::string Text(const MacAddress &address)
{
    char text[18];
    std::snprintf(text, sizeof(text), "%02x:%02x:%02x:%02x:%02x:%02x", address[0], address[1], address[2],
                  address[3], address[4], address[5]);
    return text;
}

int Duplicate(int file)
{
    const int copy = dup(file);
    if (copy < 0)
    {
        throw std::system_error(errno, std::generic_category(), "dup");
    }
    return copy;
}

}  // namespace

RadioProgram::RadioProgram(const RadioOptions &options) : _medium(options.Medium), _buffer(LargestFrame)
{
    if (!options.Pcap.empty())
    {
        const auto since1970 = std::chrono::system_clock::now().time_since_epoch();
        _pcap.emplace(options.Pcap, std::chrono::duration_cast<Time>(since1970) - Now());
        _medium.SetTap(
            [this](Time at, const Frame &frame)
            {
                if (_pcap && !_pcap->Write(at, frame))
                {
                    std::cerr << "radio: the recording ends here, it cannot be written\n";
                    _pcap.reset();
                }
            });
    }
    nlohmann::json addresses = nlohmann::json::object();
    _devices.reserve(options.Nodes.size());
    for (const auto &[name, space] : options.Nodes)
    {
        const auto number = _devices.size() + 1;
        // A locally administered address.
        const MacAddress address{
            2, 0x52, 0x62, 0, static_cast<std::uint8_t>(number >> 8), static_cast<std::uint8_t>(number)};
        _medium.Add(name, address);
        _devices.emplace_back(_io, TapDevice(space, options.Device, address).Release());
        addresses[name] = Text(address);
    }
    _addresses = addresses.dump();
    OpenControl(options.Control);
}

void RadioProgram::Run()
{
    _signals.add(SIGINT);
    _signals.add(SIGTERM);
    _signals.async_wait([this](const boost::system::error_code &, int) { _io.stop(); });
    const bool realtime = BecomeRealtime();
    for (std::size_t node = 0; node < _devices.size(); ++node)
    {
        Wait(node);
    }
    std::cout << R"({"ready":true,"addresses":)" << _addresses << R"(,"realtime":)" << std::boolalpha
              << realtime << "}" << std::endl;
    _io.run();
    if (!_control.empty())
    {
        unlink(_control.c_str());
    }
}

void RadioProgram::OpenControl(const std::string &path)
{
    if (path.empty())
    {
        Converse(Stream(_io, Duplicate(STDIN_FILENO)), Stream(_io, Duplicate(STDOUT_FILENO)), true);
        return;
    }
    unlink(path.c_str());
    _acceptor.emplace(_io, Local::endpoint(path));
    _control = path;
    Accept();
}

void RadioProgram::Accept()
{
    _acceptor->async_accept(
        [this](const boost::system::error_code &error, Local::socket socket)
        {
            if (!error)
            {
                const int file = socket.release();
                Converse(Stream(_io, Duplicate(file)), Stream(_io, file), false);
            }
            Accept();
        });
}

void RadioProgram::Converse(Stream in, Stream out, bool endsAll)
{
    const auto session = std::make_shared<ControlSession>(
        std::move(in), std::move(out), [this](const std::string &line) { return Answer(line); },
        [this, endsAll]
        {
            if (endsAll)
            {
                _io.stop();
            }
        });
    session->Start();
}

void RadioProgram::Wait(std::size_t node)
{
    _devices[node].async_wait(Stream::wait_read,
                              [this, node](const boost::system::error_code &error)
                              {
                                  if (!error)
                                  {
                                      ReadAll(node);
                                  }
                              });
}

void RadioProgram::ReadAll(std::size_t node)
{
    for (int k = 0; k < Batch; ++k)
    {
        const ssize_t bytes = read(_devices[node].native_handle(), _buffer.data(), _buffer.size());
        if (bytes < 0)
        {
            const int reason = errno;
            Carry();
            if (reason == EAGAIN || reason == EINTR)
            {
                Wait(node);
                return;
            }
            // The node's namespace is gone, and so is the node.
            std::cerr << "radio: " << _medium.NameOf(node)
                      << " is off the air: " << std::generic_category().message(reason) << '\n';
            return;
        }
        _medium.Offer(Now(), node, std::make_shared<const Frame>(_buffer.begin(), _buffer.begin() + bytes));
    }
    Carry();
    boost::asio::post(_io, [this, node] { ReadAll(node); });
}

void RadioProgram::Carry()
{
    _arrived.clear();
    _medium.Advance(Now(), _arrived);
    for (const Arrival &arrival : _arrived)
    {
        GiveOut(arrival);
    }
    const std::optional<Time> next = _medium.NextEvent();
    if (!next || next == _timerFor)
    {
        return;
    }
    _timerFor = next;
    _timer.expires_at(_began + *next);
    _timer.async_wait(
        [this](const boost::system::error_code &error)
        {
            if (!error)
            {
                _timerFor.reset();
                Carry();
            }
        });
}

void RadioProgram::GiveOut(const Arrival &arrival)
{
    const Time late = Now() - arrival.At;
    ++_given;
    _late += late;
    _latest = std::max(_latest, late);
    const Frame &frame = *arrival.What;
    if (write(_devices[arrival.To].native_handle(), frame.data(), frame.size()) !=
        static_cast<ssize_t>(frame.size()))
    {
        ++_unwritten;
    }
}

std::string RadioProgram::Answer(const std::string &line)
{
    Carry();
    if (line == "lateness")
    {
        return Lateness();
    }
    std::string answer = _console.Answer(Now(), line);
    Carry();
    return answer;
}

std::string RadioProgram::Lateness()
{
    const auto microseconds = [](Time time) { return static_cast<double>(time.count()) / 1000; };
    const nlohmann::json answer{{"frames", _given},
                                {"mean_us", _given ? microseconds(_late) / static_cast<double>(_given) : 0.0},
                                {"most_us", microseconds(_latest)},
                                {"unwritten", _unwritten}};
    _given = _unwritten = 0;
    _late = _latest = Time{0};
    return answer.dump();
}

}  // namespace Rabit::Radio
