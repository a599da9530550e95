#pragma once

#include <rabit/RabitMessage.h>

#include <memory>
#include <string>

// One line of text from the reading manager to the printing manager, as a post or in a queue.
class LineMessage : public Rabit::RabitMessage
{
public:
    std::string Line;

    std::unique_ptr<Rabit::RabitMessage> Clone() const override
    {
        return std::make_unique<LineMessage>(*this);
    }

    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        const auto *other = dynamic_cast<const LineMessage *>(msg);
        if (other == nullptr)
        {
            return false;
        }
        RabitMessage::CopyMessage(msg);
        Line = other->Line;
        return true;
    }

    void Clear() override
    {
        RabitMessage::Clear();
        Line.clear();
    }

    std::string ToString() const override { return Line; }
};
