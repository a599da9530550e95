#include "common/PeerProof.h"

namespace Rabit
{

bool PeerProof::MayBe(const std::string &node, std::span<const std::uint8_t, PrefixSize> prefix) const
{
    if (!_security || !_security->MayBe || _security->MayBe(node, prefix))
    {
        return true;
    }
    _log->Impostor(node);
    return false;
}

void PeerProof::Compare(const std::string &node, bool encrypts) const
{
    if (_security && _security->Encrypts != encrypts)
    {
        _log->OtherLevel(node);
    }
}

void PeerProof::Refused(const std::string &node) const
{
    _log->Stranger(node);
}

void PeerProof::Unfinished(const std::string &node) const
{
    _log->AuthenticationFailed(node);
}

}  // namespace Rabit
