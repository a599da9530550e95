#include "wire/PartsCollector.h"

#include <algorithm>

namespace Rabit
{

void PartsCollector::Begin(std::size_t size)
{
    _bytes.assign(size, 0);
    _have.assign(size, false);
    _lacking = size;
}

void PartsCollector::Add(std::size_t first, std::span<const std::uint8_t> bytes)
{
    for (std::size_t i = 0; i < bytes.size() && first + i < _bytes.size(); ++i)
    {
        _bytes[first + i] = bytes[i];
        _lacking -= _have[first + i] ? 0 : 1;
        _have[first + i] = true;
    }
}

std::size_t PartsCollector::FirstLacking() const
{
    return static_cast<std::size_t>(std::find(_have.begin(), _have.end(), false) - _have.begin());
}

}  // namespace Rabit
