// Sealing and opening a datagram of 150 bytes, on one thread. Its arguments and its output: Counting.h.
#include "Counting.h"
#include "transport/envelope/SealNodes.h"

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

namespace Rabit::Bench
{
namespace
{

using namespace SealNodes;

struct Sealing
{
    Three Nodes;
    Bytes Message = Nodes.A.Message(126);
    Bytes Room = Bytes(LargestDatagram);
    Receiver To = Nodes.A.ReceiverOf(Nodes.B);
    std::uint64_t Done = 0;

    std::span<const std::uint8_t> ToAll()
    {
        const Sealer::Result result = Nodes.A.Seals.SealGroup(Message, OuterClass::Traffic, Room);
        return std::span(Room).first(result.Size);
    }
    std::span<const std::uint8_t> ToOne()
    {
        const Sealer::Result result = Nodes.A.Seals.SealPairwise(Message, OuterClass::Traffic, To, Room);
        return std::span(Room).first(result.Size);
    }
    bool Opens(std::span<const std::uint8_t> datagram)
    {
        return Nodes.B.Opens.Open(datagram, Start).Fault == OpenFault::None;
    }
};

// A scenario of `step`, which returns true if its datagram is done.
template <typename Step>
Scenario With(const Step &step)
{
    const auto sealing = std::make_shared<Sealing>();
    return {[sealing, step] { sealing->Done += step(*sealing) ? 1 : 0; },
            [sealing] { return sealing->Done; }};
}

Scenario Find(const std::string &name)
{
    if (name == "seal-group")
    {
        return With([](Sealing &each) { return !each.ToAll().empty(); });
    }
    if (name == "seal-pairwise")
    {
        return With([](Sealing &each) { return !each.ToOne().empty(); });
    }
    if (name == "seal-open-group")
    {
        return With([](Sealing &each) { return each.Opens(each.ToAll()); });
    }
    if (name == "seal-open-pairwise")
    {
        return With([](Sealing &each) { return each.Opens(each.ToOne()); });
    }
    if (name == "open-replay")
    {
        return With(
            [](Sealing &each)
            {
                if (each.Done == 0)
                {
                    each.Opens(each.ToAll());
                    each.Room.resize(each.Message.size() + 71);
                }
                return !each.Opens(each.Room);
            });
    }
    throw std::invalid_argument("there is no scenario " + name);
}

}  // namespace
}  // namespace Rabit::Bench

int main(int argc, char **argv)
{
    return Rabit::Bench::Count(argc, argv, Rabit::Bench::Find);
}
