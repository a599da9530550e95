#include <rabit/dynamic/DynamicMessage.h>

#include <rabit/idl/GeneratedMessageType.h>

#include <stdexcept>
#include <utility>

namespace Rabit
{

DynamicMessage::DynamicMessage(std::shared_ptr<const DynamicType> type) : _type(std::move(type))
{
    if (!_type)
    {
        throw std::invalid_argument("DynamicMessage: no type");
    }
}

const std::vector<std::uint8_t> &DynamicMessage::Sample() const
{
    return _sample.empty() ? _type->DefaultSample() : _sample;
}

bool DynamicMessage::SetSample(std::span<const std::uint8_t> sample)
{
    auto normal = _type->Normalized(sample);
    if (normal)
    {
        _sample = std::move(*normal);
    }
    return normal.has_value();
}

std::string DynamicMessage::ToJson() const
{
    return _type->ToJson(Sample()).value_or("");
}

std::string DynamicMessage::SetJson(std::string_view json)
{
    EncodedSample encoded = _type->FromJson(json);
    if (encoded.Sample)
    {
        _sample = std::move(*encoded.Sample);
    }
    return encoded.Reason;
}

std::unique_ptr<RabitMessage> DynamicMessage::Clone() const
{
    return std::make_unique<DynamicMessage>(*this);
}

bool DynamicMessage::CopyMessage(RabitMessage *msg)
{
    if (msg == nullptr || !_type->IsTypeOf(*msg))
    {
        return false;
    }
    RabitMessage::CopyMessage(msg);
    _sample = static_cast<const DynamicMessage *>(msg)->_sample;
    return true;
}

void DynamicMessage::Clear()
{
    RabitMessage::Clear();
    _sample.clear();
}

std::string DynamicMessage::ToString() const
{
    return _type->ToText(Sample()).value_or(_type->Name());
}

int DynamicMessage::Serialize(std::uint8_t *buf, int maxBufSize, int stype)
{
    return Idl::SerializeTo(*_type, *this, buf, maxBufSize, stype);
}

int DynamicMessage::DeSerialize(std::uint8_t *buf, int len, int stype)
{
    return Idl::DeserializeFrom(*_type, *this, buf, len, stype);
}

}  // namespace Rabit
