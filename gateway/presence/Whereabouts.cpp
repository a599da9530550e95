#include "presence/Whereabouts.h"

#include <rabit/base/Printable.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "wire/BeatNews.h"

namespace Rabit::Whereabouts
{

std::string OfThisProcess()
{
    // The process id is what tells two hosts of one name apart: a long name of the host gives way to it.
    const std::string process = ", process " + std::to_string(::getpid());
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0 || host.front() == '\0')
    {
        host = {'?'};
    }
    const std::string text = "host " + std::string(host.data());
    return text.substr(0, Size - process.size()) + process;
}

Gateway::AnnouncementPart Part()
{
    const std::string text = OfThisProcess();
    Gateway::AnnouncementPart part;
    part.bytes.assign(text.begin(), text.end());
    part.bytes.resize(Size, 0);
    return part;
}

std::string In(const Gateway::Beat &beat, const std::string &known)
{
    const auto &parts = NewsOf(beat).parts;
    if (parts.empty() || !IsIn(parts.front()))
    {
        return known;
    }
    const auto &bytes = parts.front().bytes;
    const auto end = std::find(bytes.begin(), bytes.end(), 0);
    std::string text(bytes.begin(), end);
    text.resize(std::min(text.size(), Size));
    return text.empty() ? known : Printable(std::move(text));
}

}  // namespace Rabit::Whereabouts
