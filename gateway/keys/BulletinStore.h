#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "envelope/Types.h"
#include "envelope/VerifyingKey.h"
#include "keys/Armour.h"

namespace Rabit::Keys
{

// The newest bulletins of a fleet by their epochs. A node needs former ones, too: it tells nodes that have
// not heard of the newest one in an epoch that those know.
using Bulletins = std::map<Envelope::Epoch, Bytes>;

// Drops the oldest ones until as many are left as EpochSecrets keeps.
void KeepNewest(Bulletins &bulletins);
std::string TextOf(const Bulletins &bulletins);
// Throws KeysError, which names `file`, unless the authority signed each bulletin in the text.
Bulletins ReadBulletins(std::string_view text, Envelope::VerifyingKey &authority, const std::string &file);

// Where a running node stores the bulletins that it hears of: in the `bulletin` of its folder of keys. If
// that cannot be written, they go to `fallback`, unless that is empty. One call at a time.
class BulletinStore
{
public:
    BulletinStore(std::string file, std::string fallback, Bulletins known, Envelope::VerifyingKey authority);

    // Adds one, and replaces the file as a whole. Bulletins that a person copied there meanwhile hold,
    // if the authority signed them all. Returns false if it could be stored at neither place. Throws nothing.
    bool Add(Envelope::Epoch epoch, std::span<const std::uint8_t> bulletin);

private:
    const std::string _file;
    const std::string _fallback;
    Bulletins _known;
    Envelope::VerifyingKey _authority;
};

}  // namespace Rabit::Keys
