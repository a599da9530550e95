#include "ShortenedDatagram.h"

#include "OutgoingMessage.h"
#include "common/RtpsWriter.h"
#include "guard/RtpsMessage.h"

namespace Rabit::FastDds
{

using namespace Rtps;

namespace
{

// Larger datagrams keep their INFO_DST: the copy without it costs more than the 16 bytes, which are less
// than half a percent of them.
constexpr std::size_t LargestShortened = 4096;

}  // namespace

ShortenedDatagram::ShortenedDatagram(std::span<const std::uint8_t> whole, std::vector<std::uint8_t> &copy)
    : _whole(whole),
      _bytes(whole.first(SizeWithoutStatistics(whole))),
      _statistics(whole.subspan(_bytes.size())),
      _copy(copy)
{
}

void ShortenedDatagram::LeaveOutProperties()
{
    WriteWithoutProperties(_bytes, _copy);
    _bytes = _copy;
}

void ShortenedDatagram::LeaveOutDestination()
{
    if (_bytes.size() <= LargestShortened)
    {
        WriteWithoutDestination(_bytes, _copy);
        _bytes = _copy;
    }
}

void ShortenedDatagram::PutBackStatistics()
{
    if (_statistics.empty() || !EndsLikeStatistics(_bytes))
    {
        return;
    }
    if (_bytes.data() == _whole.data())
    {
        _bytes = _whole;
    }
    else
    {
        Append(_copy, _statistics);
        _bytes = _copy;
    }
}

}  // namespace Rabit::FastDds
