#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "configuration/ValidateGatewayConfig.h"

namespace Rabit
{

// The base of the checks of each section. Each function throws ConfigError with the line that it is given; a
// `key` is named in the error.
class ConfigCheck
{
public:
    ConfigCheck(const GatewayConfig &config, const TypeCheck &whyNoType)
        : _config(config), _whyNoType(whyNoType)
    {
    }

protected:
    [[noreturn]] void Fail(int line, const std::string &message) const;
    // The line of a setting, such as `record.folder`; 0: the configuration is from no file.
    int LineOf(const std::string &key) const;

    void CheckType(const std::string &type, int line) const;
    // A pattern, or a list of patterns, of node names.
    void CheckPattern(const std::string &pattern, const char *key, int line) const;
    void CheckPatterns(const std::vector<std::string> &patterns, const char *key, int line) const;
    void CheckMessagePatterns(const std::vector<std::string> &patterns, const char *key, int line,
                              const std::string &what = "message name") const;
    void CheckNoneTwice(const std::vector<std::string> &list, const char *key, int line) const;
    // Remembers a name of the section `list`; fails if it was there before.
    void CheckOnce(std::map<std::string, int> &seen, const std::string &name, const char *list,
                   int line) const;
    // From 1 to `most`.
    void CheckRange(std::size_t value, std::size_t most, const char *key, int line) const;
    void CheckMaxRate(double rate, int line) const;
    static std::string WithoutWildcards(std::string pattern);

    const GatewayConfig &_config;
    const TypeCheck &_whyNoType;
};

// Check the sections of a configuration. Throw ConfigError.
void CheckRecording(const GatewayConfig &config, const TypeCheck &whyNoType);  // `record`, `fetch`
void CheckMessages(const GatewayConfig &config,
                   const TypeCheck &whyNoType);  // `publish`, `subscribe`, `accept`, `send`

}  // namespace Rabit
