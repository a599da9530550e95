#include "MemberScore.h"

#include "Usage.h"

#include <csignal>
#include <iostream>
#include <sstream>

namespace Rabit::Bench
{
namespace
{

volatile std::sig_atomic_t asked = 0;

}  // namespace

MemberScore::MemberScore(const BenchOptions &options)
    : _heard(options.Members + 1, false), _missing(options.Members - 1)
{
    _heard.at(options.Member) = true;
    struct sigaction action = {};
    action.sa_handler = [](int) { asked = 1; };
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, nullptr);
}

void MemberScore::Heard(std::size_t member)
{
    if (member == 0 || member >= _heard.size())
    {
        ++_strangers;
        return;
    }
    ++_received;
    if (_heard[member])
    {
        return;
    }
    _heard[member] = true;
    if (--_missing == 0)
    {
        std::cout << "{\"all_heard_at_ns\": " + std::to_string(Now()) + "}\n" << std::flush;
    }
}

void MemberScore::ReportIfAsked()
{
    if (asked != 0)
    {
        asked = 0;
        Report();
    }
}

void MemberScore::Report() const
{
    const Usage used = Usage::Take();
    std::ostringstream out;
    out << "{\"at_ns\": " << Now() << ", \"sent\": " << _sent << ", \"received\": " << _received
        << ", \"strangers\": " << _strangers << ", \"cpu_ns\": " << used.Processor
        << ", \"allocations\": " << used.Allocations << ", \"sleeps\": " << used.Switches
        << ", \"missing\": [" << Missing() << "]}\n";
    std::cout << out.str() << std::flush;
}

std::string MemberScore::Missing() const
{
    std::string list;
    for (std::size_t member = 1; member < _heard.size(); ++member)
    {
        if (!_heard[member])
        {
            list += (list.empty() ? "" : ", ") + std::to_string(member);
        }
    }
    return list;
}

}  // namespace Rabit::Bench
