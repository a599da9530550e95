// Recordings: their summaries, their records, their messages, and what is recovered of them.
#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/McapRecovery.h>
#include <rabit/mcap/MessageCursor.h>

#include <algorithm>

#include "Input.h"

namespace
{

class Memory final : public Rabit::Mcap::ByteSource
{
public:
    explicit Memory(std::span<const std::uint8_t> bytes) : _bytes(bytes) {}

    std::uint64_t Size() override { return _bytes.size(); }
    bool Read(std::uint64_t offset, std::span<std::uint8_t> to) override
    {
        const bool is = offset <= _bytes.size() && to.size() <= _bytes.size() - offset;
        if (is)
        {
            std::copy_n(_bytes.begin() + static_cast<std::ptrdiff_t>(offset), to.size(), to.begin());
        }
        return is;
    }

private:
    std::span<const std::uint8_t> _bytes;
};

class Nowhere final : public Rabit::Mcap::ByteSink
{
public:
    bool Write(std::span<const std::uint8_t>) override { return true; }
};

}  // namespace

int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    Memory memory({data, size});
    for (const auto &contents : {Rabit::Mcap::ReadContents(memory), Rabit::Mcap::ScanContents(memory)})
    {
        Rabit::Mcap::MessageCursor cursor(memory, contents, {});
        std::uint64_t before = 0;
        for (int i = 0; i < 1000; ++i)
        {
            const auto message = cursor.Next();
            if (!message)
            {
                break;
            }
            Fuzz::Require(message->LogTime >= before);
            before = message->LogTime;
        }
    }
    Nowhere nowhere;
    Rabit::Mcap::McapWriter writer(nowhere, {});
    Rabit::Mcap::Recover(memory, writer);
    return 0;
}
