#pragma once

#include <rabit/gateway/links/LinkMessages.h>

namespace Rabit
{

// What became of the last LinkOutcomeBits messages that a receiver consumed: bit i stands for the one
// consumed i messages ago.
class OutcomeHistory
{
public:
    enum class Entry
    {
        Delivered,
        Skipped,
        Refused
    };

    void Clear();
    void Push(Entry entry);
    const LinkBitmap &Delivered() const { return _delivered; }
    const LinkBitmap &Refused() const { return _refused; }

    // Whether bit `age` is set; false beyond the bitmap.
    static bool Test(const LinkBitmap &bits, std::uint64_t age);

private:
    LinkBitmap _delivered{};
    LinkBitmap _refused{};
};

}  // namespace Rabit
