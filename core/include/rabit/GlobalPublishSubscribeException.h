#pragma once

#include <exception>
#include <iostream>
#include <sstream>
#include <string>

namespace Rabit
{

// Thrown when a message is posted, fetched or watched that is not registered under any name.
class GlobalPublishSubscribeException : public std::exception
{
public:
    GlobalPublishSubscribeException();
    explicit GlobalPublishSubscribeException(std::string text);
    const char *what() const noexcept override;

private:
    std::string _text;
};

}  // namespace Rabit
