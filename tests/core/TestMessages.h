#pragma once

#include <rabit/RabitMessage.h>

#include <memory>
#include <string>
#include <vector>

namespace RabitTest
{

// A message as users write them: the override of CopyMessage calls the base.
class NumberMessage : public Rabit::RabitMessage
{
public:
    int Number = 0;

    std::unique_ptr<Rabit::RabitMessage> Clone() const override
    {
        return std::make_unique<NumberMessage>(*this);
    }
    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        const auto *other = dynamic_cast<const NumberMessage *>(msg);
        if (other == nullptr)
        {
            return false;
        }
        RabitMessage::CopyMessage(msg);
        Number = other->Number;
        return true;
    }
};

// Assigns the whole object.
class AssigningMessage : public Rabit::RabitMessage
{
public:
    std::string Text;

    std::unique_ptr<Rabit::RabitMessage> Clone() const override
    {
        return std::make_unique<AssigningMessage>(*this);
    }
    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        const auto *other = dynamic_cast<const AssigningMessage *>(msg);
        if (other == nullptr)
        {
            return false;
        }
        *this = *other;
        return true;
    }
};

// Copies by CopyBase, which may include the registration.
class BaseCopyingMessage : public NumberMessage
{
public:
    std::unique_ptr<Rabit::RabitMessage> Clone() const override
    {
        auto clone = std::make_unique<BaseCopyingMessage>();
        clone->CopyBase(this);
        clone->Number = Number;
        return clone;
    }
    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        const auto *other = dynamic_cast<const BaseCopyingMessage *>(msg);
        if (other == nullptr)
        {
            return false;
        }
        CopyBase(other);
        Number = other->Number;
        return true;
    }
};

// Copies nothing of the base.
class ForgetfulMessage : public Rabit::RabitMessage
{
public:
    int Number = 0;

    std::unique_ptr<Rabit::RabitMessage> Clone() const override
    {
        auto clone = std::make_unique<ForgetfulMessage>();
        clone->Number = Number;
        return clone;
    }
    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        const auto *other = dynamic_cast<const ForgetfulMessage *>(msg);
        if (other == nullptr)
        {
            return false;
        }
        Number = other->Number;
        return true;
    }
};

}  // namespace RabitTest
