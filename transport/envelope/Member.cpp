#include "envelope/Member.h"

#include <openssl/crypto.h>
#include <rabit/base/UtcText.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "envelope/Bulletin.h"
#include "envelope/KeyDerivation.h"
#include "envelope/SigningKey.h"

namespace Rabit::Envelope
{

namespace
{

std::string DayText(std::uint32_t seconds)
{
    return UtcText(static_cast<std::time_t>(seconds), "%Y-%m-%d");
}

std::int64_t UtcOfHost()
{
    return std::chrono::duration_cast<std::chrono::seconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

std::string EpochText(Epoch epoch)
{
    return "epoch " + std::to_string(epoch);
}

}  // namespace

Member::Member(MemberKeys &&keys, Clocks clocks, VerifyingKey authority, AgreementKey agreement)
    : _clocks(std::move(clocks)),
      _signing(keys.SigningKey),
      _agreementBytes(keys.AgreementKey),
      _authorityKey(keys.Authority),
      _certificateBytes(std::move(keys.Certificate)),
      _store(std::move(keys.Store)),
      _agreement(std::move(agreement)),
      _list(std::make_shared<const std::vector<std::uint8_t>>(std::move(keys.Permissions))),
      _authority(std::move(authority))
{
    OPENSSL_cleanse(keys.SigningKey.data(), keys.SigningKey.size());
    OPENSSL_cleanse(keys.AgreementKey.data(), keys.AgreementKey.size());
}

Member::Made Member::Make(MemberKeys &&keys, Clocks clocks)
{
    auto authority = VerifyingKey::Of(keys.Authority);
    auto agreement = AgreementKey::Of(SecretKey(keys.AgreementKey));
    if (!authority || !agreement)
    {
        return {.Of = nullptr, .Error = "OpenSSL does not take the keys"};
    }
    const auto bulletins = std::move(keys.Bulletins);
    const std::shared_ptr<Member> made(
        new Member(std::move(keys), std::move(clocks), std::move(*authority), std::move(*agreement)));
    std::string error = made->TakeKeys();
    if (error.empty())
    {
        error = made->TakeStored(bulletins);
    }
    return {.Of = error.empty() ? made : nullptr, .Error = error};
}

std::string Member::TakeKeys()
{
    const auto certificate = ReadCertificate(_certificateBytes);
    if (!certificate)
    {
        return "the certificate is damaged";
    }
    _certificate = *certificate;
    if (!IsCertifiedBy(_certificateBytes, _authority))
    {
        return "the certificate of " + Name() + " was not signed by this authority";
    }
    const auto signing = SigningKey::Of(_signing);
    if (!signing || signing->Public() != _certificate.Signing ||
        _agreement.Public() != _certificate.Agreement)
    {
        return "the keys do not belong to the certificate of " + Name();
    }
    if (Permissions::HashOf(*_list) != _certificate.Permissions)
    {
        return "the list of permissions does not belong to the certificate of " + Name();
    }
    return AddList(_certificate.Permissions, *_list) ? "" : "the list of permissions is damaged";
}

std::string Member::TakeStored(const std::vector<std::vector<std::uint8_t>> &bulletins)
{
    if (bulletins.empty())
    {
        return "there is no bulletin";
    }
    const TimePoint now = _clocks.Steady();
    for (const auto &bytes : bulletins)
    {
        const auto read = Envelope::Bulletin::Read(bytes, _authority);
        if (!read)
        {
            return "a bulletin is damaged, or was not signed by this authority";
        }
        // Bulletins that are older than the certificate do not name it.
        if (const auto secret = read->Secret(_certificate.Number, _agreement))
        {
            Use(*read, *secret, std::make_shared<const std::vector<std::uint8_t>>(bytes), now);
        }
        else if (&bytes == &bulletins.back())
        {
            return "the bulletin of " + EpochText(read->Epoch()) + " has no secret for " + Name() +
                   ": its certificate is revoked, or newer than the bulletin";
        }
    }
    return "";
}

void Member::Use(const Envelope::Bulletin &read, const SecretKey &secret, Bytes content, TimePoint now)
{
    if (!_epochs.Learn(read.Epoch(), secret, read.Revoked(), now))
    {
        return;
    }
    const Hash hash = Sha256(*content);
    _bulletins.insert(hash);
    _bulletin = {.Of = hash, .Content = std::move(content)};
    _version.fetch_add(1, std::memory_order_release);
    _lasting.End(ProblemKind::UnknownEpoch);
}

std::vector<SettingsProblem> Member::Problems() const
{
    const std::lock_guard lock(_mutex);
    std::vector<SettingsProblem> rows = _lasting.Rows(_clocks.Steady());
    for (const auto &[entry, text] : _certain)
    {
        rows.push_back({.Setting = "security", .Entry = entry, .Text = text});
    }
    AppendDates(rows);
    return rows;
}

// Dates are warnings: a wrong clock must not part a fleet.
void Member::AppendDates(std::vector<SettingsProblem> &rows) const
{
    const std::int64_t utc = _clocks.Utc();
    const auto append = [&](const std::string &name, std::uint32_t begins, std::uint32_t ends)
    {
        if (utc < std::int64_t{begins})
        {
            rows.push_back({.Setting = "security",
                            .Entry = name,
                            .Text = "the certificate of " + name + " begins on " + DayText(begins) +
                                    ": check this host's clock"});
        }
        else if (utc > std::int64_t{ends})
        {
            rows.push_back(
                {.Setting = "security",
                 .Entry = name,
                 .Text = "the certificate of " + name + " ended on " + DayText(ends) + ": make a new one"});
        }
    };
    append(Name(), _certificate.Begins, _certificate.Ends);
    for (const auto &[name, named] : _named)
    {
        if (name != Name())
        {
            append(name, named.Begins, named.Ends);
        }
    }
}

std::optional<Self> Member::SelfIn(const SessionId &session, std::vector<RtpsHeader> headers) const
{
    return Self::Of(_signing, _agreementBytes, session, _certificateBytes, std::move(headers));
}

EpochSecrets Member::Epochs() const
{
    const std::lock_guard lock(_mutex);
    return _epochs;
}

Member::NewestBulletin Member::Newest() const
{
    const std::lock_guard lock(_mutex);
    return _bulletin;
}

bool Member::KnowsBulletin(const Hash &hash) const
{
    const std::lock_guard lock(_mutex);
    return _bulletins.contains(hash) || _refused.Find(hash) != nullptr;
}

std::string Member::Learn(std::vector<std::uint8_t> bulletin)
{
    const std::lock_guard learning(_learning);
    const Hash hash = Sha256(bulletin);
    if (KnowsBulletin(hash))
    {
        return "";
    }
    const auto read = Envelope::Bulletin::Read(bulletin, _authority);
    const auto secret = read ? read->Secret(_certificate.Number, _agreement) : std::nullopt;
    const bool isNewer = read && read->Epoch() > Epochs().Newest();
    if (!isNewer || !secret)
    {
        {
            const std::lock_guard lock(_mutex);
            _refused.Put(hash, true);
        }
        if (!read)
        {
            // A member can send such ones again and again.
            Note(Name(), "bulletins are refused that the authority of this fleet did not sign",
                 _clocks.Steady());
        }
        if (!isNewer)
        {
            return "";
        }
        const std::string text = "the bulletin of " + EpochText(read->Epoch()) +
                                 " has no secret for this node: its certificate was revoked; make new keys";
        NoteCertain(Name(), text);
        return text;
    }
    if (!_store || _store(read->Epoch(), bulletin))
    {
        const std::lock_guard lock(_mutex);
        _certain.erase(Name());
    }
    else
    {
        NoteCertain(Name(), "the bulletin of " + EpochText(read->Epoch()) +
                                " could not be stored: after a restart this node has to hear it again");
    }
    const std::lock_guard lock(_mutex);
    // Refers to `bulletin` until here.
    Use(*read, *secret, std::make_shared<const std::vector<std::uint8_t>>(bulletin), _clocks.Steady());
    return "the bulletin of " + EpochText(_epochs.Newest()) + " came: this node sends in that epoch now";
}

std::shared_ptr<const Permissions> Member::ListOf(const Hash &hash) const
{
    const std::lock_guard lock(_mutex);
    const auto *const found = _lists.Find(hash);
    return found == nullptr ? nullptr : *found;
}

bool Member::AddList(const Hash &hash, std::span<const std::uint8_t> bytes)
{
    auto list = Permissions::Read(bytes);
    if (!list)
    {
        return false;
    }
    const std::lock_guard lock(_mutex);
    _lists.Put(hash, std::make_shared<const Permissions>(std::move(*list)));
    return true;
}

void Member::Note(const std::string &entry, const std::string &text, TimePoint now, ProblemKind kind)
{
    const std::lock_guard lock(_mutex);
    _lasting.Note(entry, text, kind, now);
}

bool Member::NoteCertain(const std::string &entry, const std::string &text)
{
    const std::lock_guard lock(_mutex);
    return (_certain.size() < MostCertain || _certain.contains(entry)) &&
           _certain.insert_or_assign(entry, text).second;
}

void Member::NoteCertificate(const Envelope::Certificate &certificate)
{
    const std::lock_guard lock(_mutex);
    if (_named.size() < MostNames || _named.contains(certificate.Name))
    {
        _named[certificate.Name] = {.Begins = certificate.Begins, .Ends = certificate.Ends};
    }
}

}  // namespace Rabit::Envelope

namespace Rabit
{

MadeMember MakeFleetMember(MemberKeys keys)
{
    auto made = Envelope::Member::Make(
        std::move(keys),
        {.Steady = [] { return Envelope::TimePoint::clock::now(); }, .Utc = Envelope::UtcOfHost});
    return {.Member = std::move(made.Of), .Error = std::move(made.Error)};
}

}  // namespace Rabit
