#include "KeptInstance.h"

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/ddsi_tkmap.h>
#include <dds/ddsi/q_thread.h>

struct ddsi_tkmap_instance *RabitCycloneKeepInstance(struct ddsi_serdata *key)
{
    struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&key->type->gv);
    if (domain == NULL)
    {
        return NULL;
    }
    thread_state_awake(lookup_thread_state(), domain);
    struct ddsi_tkmap_instance *instance = ddsi_tkmap_lookup_instance_ref(domain->m_tkmap, key);
    thread_state_asleep(lookup_thread_state());
    return instance;
}

void RabitCycloneLetInstanceGo(const struct ddsi_sertype *type, struct ddsi_tkmap_instance *instance)
{
    struct ddsi_domaingv *domain = ddsrt_atomic_ldvoidp(&type->gv);
    if (domain == NULL || instance == NULL)
    {
        return;
    }
    thread_state_awake(lookup_thread_state(), domain);
    ddsi_tkmap_instance_unref(domain->m_tkmap, instance);
    thread_state_asleep(lookup_thread_state());
}
