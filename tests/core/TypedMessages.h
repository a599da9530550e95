// Messages whose CopyMessage decides which types are one.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "TestMessages.h"

namespace RabitTest
{

// A class of several types, which tells them apart by itself.
class ManyTypedMessage : public NumberMessage
{
public:
    explicit ManyTypedMessage(std::string type) : Type(std::move(type)) {}

    const std::string Type;

    std::unique_ptr<Rabit::RabitMessage> Clone() const override
    {
        return std::make_unique<ManyTypedMessage>(*this);
    }
    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        const auto *other = dynamic_cast<const ManyTypedMessage *>(msg);
        return other != nullptr && other->Type == Type && NumberMessage::CopyMessage(msg);
    }
};

// Returns false although it copies.
class DenyingMessage : public NumberMessage
{
public:
    std::unique_ptr<Rabit::RabitMessage> Clone() const override
    {
        return std::make_unique<DenyingMessage>(*this);
    }
    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        NumberMessage::CopyMessage(msg);
        return false;
    }
};

}  // namespace RabitTest
