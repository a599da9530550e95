#pragma once

#include <rabit/dynamic/DynamicType.h>
#include <rabit/idl/SelfDescribing.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace Rabit
{

// A message of a DynamicType; its contents are a sample. Made by DynamicType::Create, or by the
// constructor. The messages of all dynamic types have this one class. Copying the contents of a message of
// another type is refused, and leaves this one unchanged.
class DynamicMessage final : public RabitMessage, public Idl::SelfDescribing
{
public:
    // With default values. Throws std::invalid_argument if type is null.
    explicit DynamicMessage(std::shared_ptr<const DynamicType> type);

    const DynamicType &Type() const { return *_type; }
    const Rabit::MessageType &IdlType() const override { return *_type; }
    // The sample: plain XCDR1, little endian, with its encapsulation header. Valid until the message changes.
    const std::vector<std::uint8_t> &Sample() const;
    // Takes over a sample of either byte order. If it is not a sample of this type, returns false and
    // changes nothing.
    bool SetSample(std::span<const std::uint8_t> sample);
    // The contents as JSON, see DynamicType; empty if it would be too large.
    std::string ToJson() const;
    // Takes over JSON. Returns an empty text; if it does not fit, returns the reason and changes nothing.
    std::string SetJson(std::string_view json);

    std::unique_ptr<RabitMessage> Clone() const override;
    bool CopyMessage(RabitMessage *msg) override;
    void Clear() override;
    std::string ToString() const override;
    int Serialize(std::uint8_t *buf, int maxBufSize, int stype = 0) override;
    int DeSerialize(std::uint8_t *buf, int len, int stype = 0) override;

private:
    std::shared_ptr<const DynamicType> _type;
    std::vector<std::uint8_t> _sample;  // empty: the default sample of the type
};

}  // namespace Rabit
