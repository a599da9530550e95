#include "SealedTraffic.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "DomainConfig.h"
#include "Places.h"
#include "guard/RtpsMessage.h"
#include "rtps/CardMessage.h"

namespace Rabit::Cyclone
{

namespace
{

Envelope::RtpsHeader HeaderOf(std::span<const std::uint8_t> message)
{
    Envelope::RtpsHeader header{};
    std::copy_n(message.begin(), header.size(), header.begin());
    return header;
}

// The parts, one behind the other: the only one, or a copy in `buffer`.
std::span<const std::uint8_t> Gathered(std::span<const ddsrt_iovec_t> parts,
                                       std::vector<std::uint8_t> &buffer)
{
    const auto bytesOf = [](const ddsrt_iovec_t &part)
    { return std::span(static_cast<const std::uint8_t *>(part.iov_base), part.iov_len); };
    if (parts.size() == 1)
    {
        return bytesOf(parts.front());
    }
    buffer.clear();
    for (const ddsrt_iovec_t &part : parts)
    {
        const auto bytes = bytesOf(part);
        buffer.insert(buffer.end(), bytes.begin(), bytes.end());
    }
    return buffer;
}

}  // namespace

void CheckSealable(const TransportSettings &settings)
{
    if (settings.SharedMemory)
    {
        throw TransportError("a node with keys shares no memory with others: leave shared_memory out",
                             "shared_memory");
    }
    if (GuardMode(settings) != Rtps::RtpsGuard::Mode::Full)
    {
        throw TransportError("the configuration " + settings.BackendConfig +
                                 " has SharedMemory, by which datagrams would pass by the keys",
                             "backend_config");
    }
}

SealedTraffic::SealedTraffic(const std::shared_ptr<FleetMember> &member,
                             const std::shared_ptr<DiscoveryTurns> &turns,
                             Envelope::SealedSession::Calls calls)
    : _calls(std::move(calls)), _session(member, turns)
{
}

void SealedTraffic::Begin(const Envelope::RtpsHeader &vendor)
{
    const auto card = Rtps::WriteCardMessage({.From = Rtps::SenderOf(vendor)});
    _session.Start(vendor, HeaderOf(card), _calls);
}

void SealedTraffic::Begin(const Rtps::GuidPrefix &own)
{
    // Of RTPS 2.1 and Eclipse Cyclone DDS (OMG DDSI-RTPS 2.3, 8.3.3.1).
    Envelope::RtpsHeader header{'R', 'T', 'P', 'S', 2, 1, 1, 16};
    std::copy(own.begin(), own.end(), header.begin() + Rtps::PrefixAt);
    Begin(header);
}

RabitCycloneSealed SealedTraffic::Seal(std::span<const ddsrt_iovec_t> parts, const RabitCyclonePlace *to)
{
    thread_local std::vector<std::uint8_t> gathered;
    thread_local std::vector<std::uint8_t> sealed;
    const std::span<const std::uint8_t> message = Gathered(parts, gathered);
    // The meeting's thread may be faster than the vendor's.
    if (!_session.IsStarted() && message.size() >= Rtps::RtpsHeaderSize && !Rtps::IsCardMessage(message))
    {
        Begin(HeaderOf(message));
    }
    const std::optional<Rtps::Place> place =
        to == nullptr ? std::nullopt : std::optional<Rtps::Place>(ToPlace(*to));
    const auto contents =
        Rtps::IsCardMessage(message) ? Envelope::OuterClass::Meeting : Envelope::OuterClass::Traffic;
    return _session.Seal(message, place, contents, sealed) ? RabitCycloneSealed{sealed.data(), sealed.size()}
                                                           : RabitCycloneSealed{nullptr, 0};
}

std::size_t SealedTraffic::Open(std::span<std::uint8_t> datagram, const Rtps::Place &from)
{
    const bool isWakeUp = datagram.size() == 1;  // RabitCycloneWake
    return isWakeUp ? 0 : _session.Open(datagram, from, std::chrono::steady_clock::now()).size();
}

}  // namespace Rabit::Cyclone
