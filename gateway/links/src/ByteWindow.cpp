#include "ByteWindow.h"

#include <algorithm>

namespace Rabit
{

ByteWindow::ByteWindow(const LinkOptions &options, LinkTime shortRoundTrip)
    : _smallest(options.WindowBytes),
      _largest(std::max(options.WindowBytes, options.LargestWindowBytes)),
      _shortRoundTrip(shortRoundTrip),
      _bytes(_smallest)
{
}

void ByteWindow::Measured(LinkTime roundTrip)
{
    _isShort = roundTrip <= _shortRoundTrip;
    if (!_isShort)
    {
        Restore();
    }
}

void ByteWindow::Acknowledged(std::size_t bytes, std::size_t inFlight)
{
    if (_isShort && inFlight >= _bytes / 2)
    {
        _bytes += std::min(bytes, _largest - _bytes);
    }
}

}  // namespace Rabit
