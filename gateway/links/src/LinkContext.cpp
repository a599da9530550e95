#include "LinkContext.h"

#include <algorithm>
#include <utility>

namespace Rabit
{

LinkContext::LinkContext(LinkSettings settings, LinkOutput &output, LocalQueues &queues,
                         std::uint64_t incarnation)
    : Settings(std::move(settings)),
      Output(output),
      Queues(queues),
      Clock(std::max<std::uint32_t>(static_cast<std::uint32_t>(Settings.Clock ^ (Settings.Clock >> 32)), 1)),
      Incarnation(incarnation),
      AssemblyMemory(Settings.AssemblyBytesOfNode)
{
}

}  // namespace Rabit
