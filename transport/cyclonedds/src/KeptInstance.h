/* In C, because the vendor's header of a domain's state does not compile as C++. */
#pragma once

#ifdef __cplusplus
extern "C"
{
#endif

    struct ddsi_serdata;
    struct ddsi_sertype;
    struct ddsi_tkmap_instance;

    /* Keeps the vendor's instance of a key, or of all samples of topics without a key, until it is let go.
       The vendor frees an instance that nothing keeps after each sample, and makes it anew for the next: five
       allocations. NULL if the type has no domain. */
    struct ddsi_tkmap_instance *RabitCycloneKeepInstance(struct ddsi_serdata *key);
    void RabitCycloneLetInstanceGo(const struct ddsi_sertype *type, struct ddsi_tkmap_instance *instance);

#ifdef __cplusplus
}
#endif
