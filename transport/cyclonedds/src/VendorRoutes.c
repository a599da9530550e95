/* The ways from a watched domain's sockets to other hosts. */
#include "VendorTraffic.h"

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_tran.h>
#include <dds/ddsi/q_addrset.h>
#include <dds/ddsi/q_protocol.h>
#include <string.h>

enum
{
    AddressAt = 12 /* an IPv4 address is the last four of sixteen bytes */
};

static bool IsOn(const struct nn_interface *interface, const struct RabitCyclonePlace *place)
{
    for (size_t i = 0; i < sizeof place->address; ++i)
    {
        const unsigned differing = place->address[i] ^ (unsigned)interface->loc.address[AddressAt + i];
        if ((differing & interface->netmask.address[AddressAt + i]) != 0)
        {
            return false;
        }
    }
    return true;
}

struct RabitCycloneRoute RabitCycloneRouteTo(const void *watch, const struct RabitCyclonePlace *place)
{
    const struct ddsi_domaingv *domain = RabitCycloneDomainOf(watch);
    struct RabitCycloneRoute route = {.connection = domain->xmit_conns[0], .port = place->port};
    memcpy(route.address, place->address, sizeof route.address);
    for (int i = 0; i < domain->n_interfaces; ++i)
    {
        if (IsOn(&domain->interfaces[i], place))
        {
            route.connection = domain->xmit_conns[i];
            break;
        }
    }
    return route;
}

struct RouteSink
{
    void (*found)(const struct RabitCycloneRoute *route, void *argument);
    void *argument;
};

static void FindRoute(const ddsi_xlocator_t *locator, void *argument)
{
    const struct RouteSink *sink = argument;
    if (locator->c.kind == NN_LOCATOR_KIND_UDPv4)
    {
        struct RabitCycloneRoute route = {.connection = locator->conn, .port = locator->c.port};
        memcpy(route.address, locator->c.address + AddressAt, sizeof route.address);
        sink->found(&route, sink->argument);
    }
}

void RabitCycloneAnnouncedRoutes(const void *watch,
                                 void (*found)(const struct RabitCycloneRoute *route, void *argument),
                                 void *argument)
{
    struct RouteSink sink = {found, argument};
    addrset_forall(RabitCycloneDomainOf(watch)->as_disc, FindRoute, &sink);
}
