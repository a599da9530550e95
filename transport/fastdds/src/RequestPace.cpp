#include "RequestPace.h"

#include <algorithm>

#include "guard/DeliveryCheck.h"

namespace Rabit::FastDds
{

using namespace Rtps;

bool RequestPace::MayGo(std::uint32_t socket, const FirstRequest &request, TimePoint now)
{
    const std::pair key(socket, request);
    const auto found = _asked.find(key);
    if (found == _asked.end() && _asked.size() >= MostRequests)
    {
        std::erase_if(_asked, [now](const auto &asked) { return now - asked.second.Last >= Rest; });
        if (_asked.size() >= MostRequests)
        {
            _asked.clear();
        }
    }
    if (found == _asked.end() || now - found->second.Last >= Rest)
    {
        _asked.insert_or_assign(key,
                                Asked{.Last = now, .Next = IsBuiltin(request.Writer) ? now + Patience : now});
    }
    Asked &asked = _asked.at(key);
    asked.Last = now;
    if (now < asked.Next)
    {
        return false;
    }
    asked.Next = now + asked.Gap.Next();
    return true;
}

}  // namespace Rabit::FastDds
