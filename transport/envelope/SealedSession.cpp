#include "envelope/SealedSession.h"

#include <openssl/rand.h>
#include <rabit/base/Earliest.h>

#include <utility>

#include "envelope/Member.h"
#include "envelope/SealedCore.h"

namespace Rabit::Envelope
{

namespace
{

bool FillAtRandom(std::span<std::uint8_t> bytes)
{
    return RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) == 1;
}

}  // namespace

SealedSession::SealedSession(std::shared_ptr<FleetMember> member, std::shared_ptr<DiscoveryTurns> turns)
    : _member(std::move(member)), _turns(std::move(turns))
{
    // Start must not fail: it may run on a vendor's thread.
    if (!Made({RtpsHeader{}}))
    {
        throw TransportError("OpenSSL has no random bytes, or does not take the keys of " + _member->Name(),
                             "security");
    }
    Prepare();
    // Start may run with a vendor's locks held, which Send takes in a turn.
    _turns->SetExchange(*this, DiscoveryTurns::Kind::Introduction);
}

std::unique_ptr<SealedCore> SealedSession::Made(std::vector<RtpsHeader> headers) const
{
    return SealedCore::Make(std::static_pointer_cast<Member>(_member), std::move(headers), FillAtRandom,
                            Clock::now());
}

SealedSession::~SealedSession()
{
    Stop();
}

void SealedSession::Start(const RtpsHeader &vendor, const RtpsHeader &own, Calls calls)
{
    {
        const std::lock_guard lock(_mutex);
        if (_core || IsStopped())
        {
            return;
        }
        std::vector<RtpsHeader> headers{vendor};
        if (own != vendor)
        {
            headers.push_back(own);
        }
        _calls = std::move(calls);
        _core = Made(std::move(headers));
        if (!_core)
        {
            // Nothing is sealed or opened from now on.
            static_cast<Member &>(*_member).NoteCertain(_member->Name(), "OpenSSL has no random bytes");
            return;
        }
    }
    _isStarted.store(true, std::memory_order_release);
    // A vendor's thread may send its first datagram while another one is in Stop.
    StartPrepared();
}

void SealedSession::Stop()
{
    _turns->RemoveExchange(*this);
    DueThread::Stop();
}

bool SealedSession::Seal(std::span<const std::uint8_t> message, const std::optional<Rtps::Place> &to,
                         OuterClass contents, std::vector<std::uint8_t> &sealed)
{
    return IsStarted() && _core->Seal(message, to, contents, sealed, Clock::now());
}

std::span<std::uint8_t> SealedSession::Open(std::span<std::uint8_t> datagram, const Rtps::Place &from,
                                            TimePoint now)
{
    if (!IsStarted())
    {
        return {};
    }
    const auto message = _core->Open(datagram, from, now);
    if (_core->TakeIsNew())
    {
        const std::lock_guard lock(_mutex);
        WakeIfEarlier();
    }
    return message;
}

std::vector<Rtps::Place> SealedSession::Strangers(TimePoint now) const
{
    return IsStarted() ? _core->Strangers(now) : std::vector<Rtps::Place>();
}

std::optional<std::string> SealedSession::NameOf(const Rtps::GuidPrefix &peer) const
{
    const auto found = IsStarted() ? _core->PeerOf(peer) : nullptr;
    return found ? std::optional(found->Name) : std::nullopt;
}

bool SealedSession::MayWrite(const Rtps::GuidPrefix &peer, std::string_view topic) const
{
    const auto found = IsStarted() ? _core->PeerOf(peer) : nullptr;
    return found && found->List->MayWrite(topic, found->Role);
}

bool SealedSession::MayRead(const Rtps::GuidPrefix &peer, std::string_view topic) const
{
    const auto found = IsStarted() ? _core->PeerOf(peer) : nullptr;
    return found && found->List->MayRead(topic);
}

std::size_t SealedSession::MostAdded() const
{
    return Sealer::MostAdded;
}

std::size_t SealedSession::NextBytes()
{
    const std::size_t bytes = IsStarted() ? _core->DueBytes(Clock::now()) : 0;
    if (IsStarted() && bytes == 0)
    {
        const std::lock_guard lock(_mutex);
        WakeIfEarlier();  // to wait for the next one
    }
    return bytes;
}

void SealedSession::SendNext()
{
    const auto sealed = IsStarted() ? _core->TakeDue(Clock::now()) : std::nullopt;
    if (sealed)
    {
        _calls.Send(std::nullopt, *sealed);
    }
}

// A datagram that waits for its turn is no work of the thread.
std::optional<TimePoint> SealedSession::Due()
{
    const bool waitsForTurn = _turns->IsScheduled() && _turns->IsDue();
    return Earliest({_core->LocalDue(), waitsForTurn ? std::nullopt : _core->NetworkDue()});
}

void SealedSession::Work(std::unique_lock<std::mutex> &lock)
{
    lock.unlock();
    _core->Learn();
    if (!_turns->IsScheduled())
    {
        while (const auto sealed = _core->TakeDue(Clock::now()))
        {
            _calls.Send(std::nullopt, *sealed);
        }
    }
    else if (IsBy(_core->NetworkDue(), Clock::now()))
    {
        _turns->Due();
    }
    for (const std::string &line : _core->TakeLogs())
    {
        if (_calls.Log)
        {
            _calls.Log(line);
        }
    }
    lock.lock();
}

}  // namespace Rabit::Envelope
