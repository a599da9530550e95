#pragma once

#include <rabit/gateway/ConfigError.h>

namespace Common
{

// An option or a file that a person gave is wrong. what() is one line for that person, and the program ends
// as it does when its configuration is wrong.
class BadInput : public Rabit::ConfigError
{
public:
    using Rabit::ConfigError::ConfigError;
};

}  // namespace Common
