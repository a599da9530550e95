#pragma once

#include <rabit/RabitMessage.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <typeinfo>
#include <vector>

// A small message, like the pose of an aircraft; copied like messages generated from IDL.
class PoseMessage : public Rabit::RabitMessage
{
public:
    std::array<double, 3> Position{};
    std::array<double, 4> Attitude{};
    std::uint64_t Count = 0;

    std::unique_ptr<Rabit::RabitMessage> Clone() const override
    {
        return std::make_unique<PoseMessage>(*this);
    }
    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        if (msg == nullptr || typeid(*msg) != typeid(PoseMessage))
        {
            return false;
        }
        const auto &other = static_cast<const PoseMessage &>(*msg);
        RabitMessage::CopyMessage(msg);
        Position = other.Position;
        Attitude = other.Attitude;
        Count = other.Count;
        return true;
    }

    void SetAll(std::uint64_t count)
    {
        Count = count;
        for (double &value : Position)
        {
            value = static_cast<double>(count);
        }
        for (double &value : Attitude)
        {
            value = static_cast<double>(count);
        }
    }
    // True if all values come from one SetAll.
    bool IsWhole() const
    {
        for (const double value : Position)
        {
            if (value != static_cast<double>(Count))
            {
                return false;
            }
        }
        for (const double value : Attitude)
        {
            if (value != static_cast<double>(Count))
            {
                return false;
            }
        }
        return true;
    }
};

// A large message, like an image.
class ImageMessage : public Rabit::RabitMessage
{
public:
    std::vector<std::uint8_t> Pixels = std::vector<std::uint8_t>(std::size_t{1} << 20);

    std::unique_ptr<Rabit::RabitMessage> Clone() const override
    {
        return std::make_unique<ImageMessage>(*this);
    }
    bool CopyMessage(Rabit::RabitMessage *msg) override
    {
        if (msg == nullptr || typeid(*msg) != typeid(ImageMessage))
        {
            return false;
        }
        RabitMessage::CopyMessage(msg);
        Pixels = static_cast<const ImageMessage &>(*msg).Pixels;
        return true;
    }
};
