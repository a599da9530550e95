// Owners of the vendor's entities and settings.
#pragma once

#include <dds/dds.h>
#include <rabit/transport/Transport.h>

#include <memory>
#include <string>
#include <utility>

namespace Rabit::Cyclone
{

// Owns an entity of the vendor's and all that belongs to it. Its destructor returns when no listener of the
// entity runs any more.
class Entity
{
public:
    Entity() = default;
    // Takes the result of a dds_create_ function. If that is an error, throws TransportError with `what` and
    // the vendor's reason.
    Entity(dds_entity_t handle, const std::string &what) : _handle(handle)
    {
        if (handle < 0)
        {
            throw TransportError("Cyclone DDS cannot " + what + ": " + dds_strretcode(handle));
        }
    }
    ~Entity() { Reset(); }
    Entity(Entity &&other) noexcept : _handle(std::exchange(other._handle, 0)) {}
    Entity &operator=(Entity &&other) noexcept
    {
        Reset();
        _handle = std::exchange(other._handle, 0);
        return *this;
    }
    dds_entity_t Get() const { return _handle; }
    void Reset()
    {
        if (_handle > 0)
        {
            dds_delete(std::exchange(_handle, 0));
        }
    }

private:
    dds_entity_t _handle = 0;
};

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;
inline Qos MakeQos()
{
    return {dds_create_qos(), &dds_delete_qos};
}

using Listener = std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)>;
inline Listener MakeListener(void *argument)
{
    return {dds_create_listener(argument), &dds_delete_listener};
}

}  // namespace Rabit::Cyclone
