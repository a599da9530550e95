#include <rabit/idl/GeneratedMessageType.h>

namespace Rabit::Idl
{
namespace
{

// Representation identifiers of OMG DDSI-RTPS 2.3, table 10.3. All others (parameter lists, XCDR2) are
// refused.
constexpr std::uint8_t CdrBigEndian = 0;
constexpr std::uint8_t CdrLittleEndian = 1;

}  // namespace

bool OpenSample(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> &body, bool &littleEndian)
{
    if (bytes.size() < EncapsulationSize || bytes[0] != 0 || bytes[1] > CdrLittleEndian)
    {
        return false;
    }
    littleEndian = bytes[1] != CdrBigEndian;
    body = bytes.subspan(EncapsulationSize);
    return true;
}

void WriteEncapsulation(std::span<std::uint8_t> sample, std::size_t padding)
{
    sample[0] = 0;
    sample[1] = CdrLittleEndian;
    sample[2] = 0;
    sample[3] = static_cast<std::uint8_t>(padding);
}

}  // namespace Rabit::Idl
