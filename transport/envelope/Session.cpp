#include "envelope/Session.h"

#include <algorithm>

namespace Rabit::Envelope
{

namespace
{

const SecretKey *PointerTo(const std::optional<SecretKey> &key)
{
    return key ? &*key : nullptr;
}

}  // namespace

bool Session::Binds(const Rtps::GuidPrefix &prefix) const
{
    return std::any_of(_headers.begin(), _headers.end(),
                       [&prefix](const RtpsHeader &header)
                       { return std::equal(prefix.begin(), prefix.end(), header.begin() + Rtps::PrefixAt); });
}

void Session::Prove(std::uint64_t number, TimePoint at, TimePoint now)
{
    if (!IsFresh(now))
    {
        _window.SetFloor(number);
        _heard = at;
    }
    _proven = true;
    _heard = std::max(_heard, at);
}

void Session::Hear(TimePoint now)
{
    if (IsFresh(now))
    {
        _heard = std::max(_heard, now);
    }
}

bool Session::IsSuspect(bool inNewest, TimePoint now) const
{
    const std::optional<TimePoint> &at = _forged[inNewest ? 1 : 0];
    return at && now - *at <= SuspectFor;
}

Session::EpochKeys &Session::KeysOf(Epoch epoch)
{
    // There are as many places as epochs are known, so the datagrams of no two epochs make each other's keys
    // be derived anew. A new epoch takes the place of the oldest.
    EpochKeys *oldest = &_keys[0];
    for (EpochKeys &keys : _keys)
    {
        if (keys.Of == epoch)
        {
            return keys;
        }
        oldest = keys.Of < oldest->Of ? &keys : oldest;
    }
    *oldest = EpochKeys{};
    oldest->Of = epoch;
    return *oldest;
}

const SecretKey *Session::GroupKeyOf(Epoch epoch, const SecretKey &secret)
{
    EpochKeys &keys = KeysOf(epoch);
    if (!keys.Group)
    {
        keys.Group = GroupKey(secret, epoch, _sender);
    }
    return PointerTo(keys.Group);
}

const SecretKey *Session::SharedWith(const AgreementKey &own)
{
    if (!_sharedTried)
    {
        _shared = own.SharedWith(_certificate->Content.Agreement);
        _sharedTried = true;
    }
    return PointerTo(_shared);
}

const SecretKey *Session::KeyFrom(Epoch epoch, const SecretKey &secret, const AgreementKey &own,
                                  const End &self)
{
    EpochKeys &keys = KeysOf(epoch);
    const SecretKey *const shared = SharedWith(own);
    if (!keys.From && shared != nullptr)
    {
        keys.From = PairwiseKey(secret, epoch, *shared, _sender, self);
    }
    return PointerTo(keys.From);
}

std::optional<Receiver> Session::ReceiverIn(Epoch epoch, const SecretKey &secret, const AgreementKey &own,
                                            const End &self)
{
    const SecretKey *const shared = SharedWith(own);
    const auto key = shared != nullptr ? PairwiseKey(secret, epoch, *shared, self, _sender) : std::nullopt;
    return key ? std::optional(Receiver{.Of = _sender, .Epoch = epoch, .Key = *key}) : std::nullopt;
}

}  // namespace Rabit::Envelope
