// Plays a stranger's sequence on a real network, for strangers_test.py. It joins the group in which
// participants announce themselves, hears what goes there, and sends its datagrams to it. Prints:
//   heard N          so many participants have spoken before the sequence begins
//   played NAME datagrams N bytes N
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <iostream>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "Sequence.h"

namespace
{

using Opponent::TimePoint;
using Clock = std::chrono::steady_clock;

constexpr std::size_t IpAndUdp = 28;

struct Options
{
    std::string Only = "mix";
    std::vector<std::string> From;
    int Domain = 0;
    std::uint64_t Seed = 1;
    int Seconds = 40;
    int Hear = 5;
};

void Check(int result, const char *what)
{
    if (result < 0)
    {
        throw std::system_error(errno, std::generic_category(), what);
    }
}

in_addr AddressOf(const std::string &text)
{
    in_addr address{};
    if (inet_pton(AF_INET, text.c_str(), &address) != 1)
    {
        throw std::invalid_argument("no address: " + text);
    }
    return address;
}

class Network
{
public:
    explicit Network(const Options &options)
    {
        // RTPS 2.3, 9.6.1.4
        _group.sin_family = AF_INET;
        _group.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * options.Domain));
        _group.sin_addr = AddressOf("239.255.0.1");
        _ear = NewSocket();
        const int yes = 1;
        Check(setsockopt(_ear, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes), "SO_REUSEADDR");
        Check(bind(_ear, reinterpret_cast<const sockaddr *>(&_group), sizeof _group), "bind");
        const ip_mreq membership{_group.sin_addr, AddressOf(options.From.front())};
        Check(setsockopt(_ear, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership),
              "IP_ADD_MEMBERSHIP");
        for (const std::string &text : options.From)
        {
            sockaddr_in from{};
            from.sin_family = AF_INET;
            from.sin_addr = AddressOf(text);
            _own.insert(from.sin_addr.s_addr);
            _mouths.push_back(NewSocket());
            Check(bind(_mouths.back(), reinterpret_cast<const sockaddr *>(&from), sizeof from), "bind");
            Check(
                setsockopt(_mouths.back(), IPPROTO_IP, IP_MULTICAST_IF, &from.sin_addr, sizeof from.sin_addr),
                "IP_MULTICAST_IF");
        }
    }
    ~Network()
    {
        for (const int each : _mouths)
        {
            close(each);
        }
        close(_ear);
    }
    Network(const Network &) = delete;
    Network &operator=(const Network &) = delete;

    // Hears until then.
    void HearUntil(TimePoint end, Opponent::Player &player)
    {
        for (auto now = Clock::now(); now < end; now = Clock::now())
        {
            pollfd ready{_ear, POLLIN, 0};
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now).count();
            if (poll(&ready, 1, static_cast<int>(left)) <= 0)
            {
                continue;
            }
            std::vector<std::uint8_t> datagram(65536);
            sockaddr_in from{};
            socklen_t size = sizeof from;
            const auto got = recvfrom(_ear, datagram.data(), datagram.size(), 0,
                                      reinterpret_cast<sockaddr *>(&from), &size);
            if (got > 0 && !_own.contains(from.sin_addr.s_addr))
            {
                player.Hears(std::span(datagram).first(static_cast<std::size_t>(got)), Clock::now());
            }
        }
    }
    void Send(const Opponent::Sent &sent)
    {
        const int mouth = _mouths[sent.From % _mouths.size()];
        const auto gone = sendto(mouth, sent.Datagram.data(), sent.Datagram.size(), 0,
                                 reinterpret_cast<const sockaddr *>(&_group), sizeof _group);
        if (gone >= 0)
        {
            ++Datagrams;
            Bytes += sent.Datagram.size() + IpAndUdp;
        }
    }

    std::uint64_t Datagrams = 0;
    std::uint64_t Bytes = 0;

private:
    static int NewSocket()
    {
        const int made = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        Check(made, "socket");
        return made;
    }

    sockaddr_in _group{};
    int _ear = -1;
    std::vector<int> _mouths;
    std::set<in_addr_t> _own;
};

void Play(const Opponent::Sequence &sequence, const Options &options)
{
    Network network(options);
    Opponent::Player player(sequence, options.Seed);
    auto now = Clock::now();
    network.HearUntil(now + std::chrono::seconds(options.Hear), player);
    std::cout << "heard " << player.Heard().Names().size() << std::endl;
    now = Clock::now();
    for (const auto end = now + std::chrono::seconds(options.Seconds); now < end; now += Opponent::TurnTime)
    {
        for (const Opponent::Sent &sent : player.Next(now))
        {
            network.Send(sent);
        }
        network.HearUntil(now + Opponent::TurnTime, player);
    }
    std::cout << "played " << sequence.Name << " datagrams " << network.Datagrams << " bytes "
              << network.Bytes << std::endl;
}

}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("A stranger who plays one sequence of datagrams.");
    Options options;
    bool list = false;
    app.add_flag("--list", list, "Print the names of the sequences, and what they do");
    app.add_option("--only", options.Only, "Name of the sequence");
    app.add_option("--from", options.From, "Own addresses, the one of the network first");
    app.add_option("--domain", options.Domain);
    app.add_option("--seed", options.Seed);
    app.add_option("--seconds", options.Seconds, "How long it plays");
    app.add_option("--hear", options.Hear, "Seconds for which it only listens first");
    CLI11_PARSE(app, argc, argv);
    const auto all = Opponent::Strangers();
    if (list)
    {
        for (const auto &sequence : all)
        {
            std::cout << sequence.Name << ": " << sequence.Does << '\n';
        }
        return 0;
    }
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto &each) { return each.Name == options.Only; });
    if (found == all.end() || options.From.empty())
    {
        std::cerr << "no sequence " << options.Only << ", or no address: see --list and --from\n";
        return 2;
    }
    try
    {
        Play(*found, options);
    }
    catch (const std::exception &error)
    {
        std::cerr << error.what() << std::endl;
        return 1;
    }
    return 0;
}
