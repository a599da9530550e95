#include "mirrors/InstanceWriter.h"

#include <utility>

#include "wire/MessageEncoder.h"

namespace Rabit
{
namespace
{

// Reads the encoded bytes in the transport's buffer, and copies them if they have another key.
class KeyWatch final : public SampleEncoder
{
public:
    KeyWatch(const MessageType &type, const SampleEncoder &sample, bool anyKnown, const KeyHash &known)
        : _type(type), _sample(sample), _anyKnown(anyKnown), _known(known)
    {
    }

    std::size_t EncodedSize() const override { return _sample.EncodedSize(); }

    bool Encode(std::span<std::uint8_t> buffer) const override
    {
        if (!_sample.Encode(buffer) || !_type.KeyHashOf(buffer, Key))
        {
            return false;
        }
        if (!_anyKnown || Key != _known)
        {
            Other.assign(buffer.begin(), buffer.end());
        }
        return true;
    }

    // The key of the sample encoded last.
    mutable KeyHash Key{};
    mutable std::vector<std::uint8_t> Other;  // empty if the key is the one known

private:
    const MessageType &_type;
    const SampleEncoder &_sample;
    const bool _anyKnown;
    const KeyHash &_known;
};

}  // namespace

InstanceWriter::InstanceWriter(const MessageType &type, std::unique_ptr<TransportWriter> writer)
    : _type(type), _writer(std::move(writer))
{
}

WriteResult InstanceWriter::Write(const RabitMessage &message, std::int64_t sourceTime, Way way)
{
    const MessageEncoder encoder(_type, message);
    if (!_type.HasKey())
    {
        return (*_writer.*way)(encoder, sourceTime);
    }
    if (DisposeFormer() == WriteResult::TimedOut)
    {
        return WriteResult::TimedOut;
    }
    KeyWatch watched(_type, encoder, !_present.empty(), _presentKey);
    const WriteResult result = (*_writer.*way)(watched, sourceTime);
    if (result != WriteResult::Ok || watched.Other.empty())
    {
        return result;
    }
    _former = std::exchange(_present, std::move(watched.Other));
    _formerEnd = sourceTime;
    _presentKey = watched.Key;
    if (_writer->HeldBytes() == 0)
    {
        DisposeFormer();  // or it is owed
    }
    return result;
}

WriteResult InstanceWriter::DisposeFormer()
{
    if (_former.empty())
    {
        return WriteResult::Ok;
    }
    const WriteResult result = _writer->Dispose(BytesEncoder(_former), _formerEnd);
    if (result != WriteResult::TimedOut)
    {
        _former.clear();
    }
    return result;
}

}  // namespace Rabit
