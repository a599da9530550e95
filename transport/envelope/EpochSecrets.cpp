#include "envelope/EpochSecrets.h"

#include <algorithm>
#include <utility>

namespace Rabit::Envelope
{

bool EpochSecrets::Learn(Epoch epoch, const SecretKey &secret, std::vector<Serial> revoked, TimePoint now)
{
    if (epoch <= Newest())
    {
        return false;
    }
    if (_known.size() == Most)
    {
        _known.erase(_known.begin());
    }
    _known.push_back({.Number = epoch, .Secret = secret, .Learned = now});
    std::sort(revoked.begin(), revoked.end());
    _revoked = std::move(revoked);
    return true;
}

const EpochSecrets::Known *EpochSecrets::Find(Epoch epoch) const
{
    const auto found = std::find_if(_known.begin(), _known.end(),
                                    [epoch](const Known &known) { return known.Number == epoch; });
    return found == _known.end() ? nullptr : &*found;
}

const SecretKey *EpochSecrets::Secret(Epoch epoch) const
{
    const Known *const known = Find(epoch);
    return known == nullptr ? nullptr : &known->Secret;
}

EpochSecrets::Use EpochSecrets::UseOf(Epoch epoch, TimePoint now) const
{
    const Known *const known = Find(epoch);
    if (known == nullptr)
    {
        return Use::None;
    }
    const bool isNewest = known == &_known.back();
    // The next newer epoch ended this one.
    return isNewest || now - (known + 1)->Learned <= Overlap ? Use::All : Use::Bulletin;
}

bool EpochSecrets::IsRevoked(Serial number) const
{
    return std::binary_search(_revoked.begin(), _revoked.end(), number);
}

}  // namespace Rabit::Envelope
