#include "DirectAnnouncements.h"

#include <algorithm>

namespace Rabit::Cyclone
{

void DirectAnnouncements::OnAnnouncement(const Address &from)
{
    const std::lock_guard lock(_mutex);
    std::erase(_known, from);
    _known.push_back(from);
    if (_known.size() > MostAddresses)
    {
        _known.pop_front();
    }
}

bool DirectAnnouncements::MayGo(const Address &to) const
{
    const std::lock_guard lock(_mutex);
    return std::find(_known.begin(), _known.end(), to) != _known.end();
}

}  // namespace Rabit::Cyclone
