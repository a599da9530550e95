// One list of messages that the tests run over: every construct, at its limits.
#pragma once

#include <rabit/RabitMessage.h>

#include <memory>
#include <string>
#include <vector>

// A message with a name for the test's output. The names of CycloneValues.h mean the same values.
struct Sample
{
    std::string Name;
    std::shared_ptr<Rabit::RabitMessage> Message;
};

std::vector<Sample> AllSamples();
// The bytes of a message, by its MessageType.
std::vector<std::uint8_t> BytesOf(const Rabit::RabitMessage &message);
// For gtest.
void PrintTo(const Sample &sample, std::ostream *out);
