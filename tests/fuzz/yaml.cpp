// Configurations of nodes.
#include <rabit/gateway/LoadGatewayConfig.h>
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "Input.h"

int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    static const int file = memfd_create("configuration", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    Fuzz::Require(ftruncate(file, 0) == 0);
    Fuzz::Require(pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
    try
    {
        Rabit::LoadGatewayConfig(path);
    }
    catch (const Rabit::ConfigError &error)
    {
        Fuzz::Require(*error.what() != '\0');
    }
    return 0;
}
