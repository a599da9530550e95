#include "keys/BulletinStore.h"

#include <rabit/keys/KeysError.h>

#include <exception>
#include <optional>
#include <utility>

#include "envelope/Bulletin.h"
#include "envelope/EpochSecrets.h"
#include "keys/KeyFiles.h"
#include "keys/MemberFiles.h"

namespace Rabit::Keys
{

void KeepNewest(Bulletins &bulletins)
{
    while (bulletins.size() > Envelope::EpochSecrets::Most)
    {
        bulletins.erase(bulletins.begin());
    }
}

std::string TextOf(const Bulletins &bulletins)
{
    std::string text;
    for (const auto &[epoch, bytes] : bulletins)
    {
        text += Armoured(BulletinLabel, bytes);
    }
    return text;
}

Bulletins ReadBulletins(std::string_view text, Envelope::VerifyingKey &authority, const std::string &file)
{
    Bulletins bulletins;
    for (Bytes &bytes : BlocksIn(text, BulletinLabel, file))
    {
        const std::optional<Envelope::Bulletin> read = Envelope::Bulletin::Read(bytes, authority);
        if (!read)
        {
            throw KeysError(file +
                            " is not signed by the authority beside it, or was changed; copy the one of this "
                            "fleet");
        }
        bulletins[read->Epoch()] = std::move(bytes);
    }
    KeepNewest(bulletins);
    return bulletins;
}

namespace
{

// Returns nothing if the file cannot be read, or if the authority did not sign all of it.
Bulletins SignedIn(const std::string &file, Envelope::VerifyingKey &authority)
{
    try
    {
        return ReadBulletins(ReadFile(file), authority, file);
    }
    catch (const KeysError &)
    {
        return {};
    }
}

}  // namespace

BulletinStore::BulletinStore(std::string file, std::string fallback, Bulletins known,
                             Envelope::VerifyingKey authority)
    : _file(std::move(file)),
      _fallback(std::move(fallback)),
      _known(std::move(known)),
      _authority(std::move(authority))
{
}

bool BulletinStore::Add(Envelope::Epoch epoch, std::span<const std::uint8_t> bulletin)
{
    try
    {
        Bulletins kept = SignedIn(_file, _authority);
        kept.try_emplace(epoch, bulletin.begin(), bulletin.end());
        kept.merge(_known);
        KeepNewest(kept);
        _known = std::move(kept);
        const std::string text = TextOf(_known);
        try
        {
            WriteFile(_file, text);
        }
        catch (const KeysError &)
        {
            if (_fallback.empty())
            {
                return false;
            }
            WriteFile(_fallback, text);
        }
        return true;
    }
    catch (const std::exception &)
    {
        return false;
    }
}

}  // namespace Rabit::Keys
