#pragma once

#include <rabit/gateway/ConfigError.h>

namespace Common
{

// Thrown if an option or a file given by a person is wrong. what() is one line for that person. The program
// ends as for a wrong configuration.
class BadInput : public Rabit::ConfigError
{
public:
    using Rabit::ConfigError::ConfigError;
};

}  // namespace Common
