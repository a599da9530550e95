#include "ParticipantNumber.h"

#include <fastdds/rtps/common/VendorId_t.hpp>

#include <algorithm>
#include <iterator>
#include <mutex>
#include <random>
#include <set>

namespace Rabit::FastDds
{

namespace rtps = eprosima::fastrtps::rtps;

namespace
{

struct Numbers
{
    std::mutex Mutex;
    std::set<std::int32_t> Taken;  // guarded by Mutex
};

Numbers &AllNumbers()
{
    static Numbers numbers;
    return numbers;
}

}  // namespace

ParticipantNumber::ParticipantNumber()
{
    Numbers &all = AllNumbers();
    const std::lock_guard lock(all.Mutex);
    while (!all.Taken.insert(_number).second)
    {
        ++_number;
    }
}

ParticipantNumber::~ParticipantNumber()
{
    Numbers &all = AllNumbers();
    const std::lock_guard lock(all.Mutex);
    all.Taken.erase(_number);
}

rtps::GuidPrefix_t MakeGuidPrefix()
{
    std::random_device random;
    std::uniform_int_distribution<int> byte(0, 255);
    rtps::GuidPrefix_t prefix;
    std::generate(std::begin(prefix.value), std::end(prefix.value),
                  [&] { return static_cast<rtps::octet>(byte(random)); });
    std::copy(rtps::c_VendorId_eProsima.begin(), rtps::c_VendorId_eProsima.end(), std::begin(prefix.value));
    return prefix;
}

}  // namespace Rabit::FastDds
