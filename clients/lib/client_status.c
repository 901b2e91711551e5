#include "fmb_client.h"

const char *fmb_client_status_text(int status)
{
    switch (status) {
#define X(name, number, text) \
    case number: return text;
        FMB_CLIENT_STATUS_MAP(X)
#undef X
    }
    return fmb_status_text(status);
}
