// Tests that run for every generated type, and for the type that is made of its IDL text at run time.
#pragma once

#include "dynamic/ReadType.h"

#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

// TEST_EACH_TYPE(Suite, Name) { ... generated ... dynamic ... }: the body runs once for each type that the
// registry has; a failure names it.
#define TEST_EACH_TYPE(suite, name)                                                                     \
    void suite##_##name##_With(const Rabit::MessageType &generated, const Rabit::DynamicType &dynamic); \
    TEST(suite, name)                                                                                   \
    {                                                                                                   \
        for (const std::string &type : Rabit::MessageTypeRegistry::Names())                             \
        {                                                                                               \
            const testing::ScopedTrace trace("type", 0, type);                                          \
            const Rabit::MessageType &made = *Rabit::MessageTypeRegistry::Find(type);                   \
            const auto parsed = Rabit::DynamicType::Parse(made.IdlText(), type);                        \
            ASSERT_TRUE(parsed.Type) << parsed.Reason << "\n" << made.IdlText();                        \
            suite##_##name##_With(made, *parsed.Type);                                                  \
            if (testing::Test::HasFatalFailure())                                                       \
            {                                                                                           \
                return;                                                                                 \
            }                                                                                           \
        }                                                                                               \
    }                                                                                                   \
    void suite##_##name##_With([[maybe_unused]] const Rabit::MessageType &generated,                    \
                               [[maybe_unused]] const Rabit::DynamicType &dynamic)

using Bytes = std::vector<std::uint8_t>;

// Returns the bytes of a message, by its type.
inline Bytes SampleOf(const Rabit::MessageType &type, const Rabit::RabitMessage &message)
{
    Bytes bytes(type.SerializedSize(message));
    bytes.resize(type.Serialize(message, bytes));
    return bytes;
}

// Returns fewer rounds for types with pages of octets, which take long.
inline int RoundsFor(const Rabit::DynamicType &type, int rounds)
{
    const bool isLarge =
        type.DefaultSample().size() > 2000 || type.IdlText().find("octet page[") != std::string::npos;
    return isLarge ? rounds / 20 : rounds;
}

// Returns the shapes that ReadType makes of the type's IDL text.
inline std::unique_ptr<const Rabit::Dynamic::Shapes> ShapesOf(const Rabit::MessageType &type)
{
    std::string reason;
    auto shapes = Rabit::Dynamic::ReadType(type.IdlText(), type.Name(), reason);
    if (!shapes)
    {
        throw std::logic_error(reason);
    }
    return shapes;
}

// Returns the bytes that generated code makes of a sample, or none if it refuses the sample.
inline Bytes ByGeneratedCode(const Rabit::MessageType &generated, const Bytes &sample)
{
    const auto message = generated.Create();
    return generated.Deserialize(sample, *message) ? SampleOf(generated, *message) : Bytes();
}
