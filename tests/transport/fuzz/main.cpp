// Records the traffic of nodes on loopback, which is RTPS or sealed. Then sends damaged copies of it to all
// ports that the traffic went to, for fuzz_test.py:
//   recording           all traffic from here on is recorded
//   recorded N ports P  after a line on standard input: N datagrams are known, of P ports
//   sent N of M         now and then
//   done N dropped D left out L    all N are sent; D were lost because a socket was full; L more were not
//                       sent, because they forge content
// Run it in a network namespace of its own: it knows only the addresses that it hears of.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>

#include "KnownContent.h"
#include "Mutator.h"
#include "Network.h"

namespace
{

constexpr std::size_t Burst = 64;
// Largest number of unread bytes of a reader. It is less than the reader's buffer, so that no datagram is
// lost.
constexpr std::size_t MostUnread = 60000;

struct Options
{
    std::uint64_t Seed = 1;
    std::uint64_t Count = 100000;
    bool KeepContent = false;
    std::string Save;
};

void Record(Sniffer &sniffer)
{
    std::cout << "recording" << std::endl;
    std::atomic<bool> begin{false};
    std::thread reader(
        [&]
        {
            std::string line;
            std::getline(std::cin, line);
            begin = true;
        });
    while (!begin)
    {
        sniffer.Read(50);
    }
    reader.join();
}

void SaveBurst(const std::string &file, const std::vector<Datagram> &burst)
{
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    for (const auto &datagram : burst)
    {
        const auto size = static_cast<std::uint32_t>(datagram.size());
        out.write(reinterpret_cast<const char *>(&size), sizeof size);
        out.write(reinterpret_cast<const char *>(datagram.data()), static_cast<std::streamsize>(size));
    }
}

int Run(const Options &options)
{
    std::vector<Datagram> recorded;
    std::vector<sockaddr_in> destinations;
    {
        Sniffer sniffer;
        Record(sniffer);
        recorded = sniffer.Kept();
        destinations = sniffer.Destinations();
    }
    std::cout << "recorded " << recorded.size() << " ports " << destinations.size() << std::endl;
    if (recorded.empty())
    {
        return 1;
    }
    Mutator mutator(options.Seed);
    mutator.Learn(recorded);
    std::mt19937_64 random(options.Seed);
    KnownContent content;
    if (options.KeepContent)
    {
        content.Learn(recorded);
    }
    std::uint64_t leftOut = 0;
    Sender sender;
    const std::uint64_t lostBefore = Sender::Dropped();
    std::vector<Datagram> burst(Burst);
    std::vector<sockaddr_in> to(Burst);
    for (std::uint64_t sent = 0; sent < options.Count; sent += Burst)
    {
        for (std::size_t i = 0; i < Burst; ++i)
        {
            burst[i] = mutator.Next();
            while (options.KeepContent && !content.Covers(burst[i]))
            {
                ++leftOut;
                burst[i] = mutator.Next();
            }
            to[i] = destinations[random() % destinations.size()];
        }
        if (!options.Save.empty())
        {
            SaveBurst(options.Save, burst);
        }
        sender.Send(burst, to);
        Sender::WaitForReaders(destinations, MostUnread);
        if (sent % (Burst * 4096) == 0)
        {
            std::cout << "sent " << sent << " of " << options.Count << std::endl;
        }
    }
    std::cout << "done " << options.Count << " dropped " << Sender::Dropped() - lostBefore << " left out "
              << leftOut << std::endl;
    return 0;
}

}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("Sends damaged copies of the RTPS traffic on loopback.");
    Options options;
    app.add_option("--seed", options.Seed, "Of the damage");
    app.add_option("--count", options.Count, "Datagrams to send");
    app.add_flag(
        "--keep-content", options.KeepContent,
        "Damages no content of samples but that of discovery; that is, sends no copy which says what its "
        "writer has not said");
    app.add_option("--save", options.Save,
                   "Keeps the burst sent last in this file, each datagram after its size");
    CLI11_PARSE(app, argc, argv);
    try
    {
        return Run(options);
    }
    catch (const std::exception &error)
    {
        std::cerr << error.what() << std::endl;
        return 1;
    }
}
