#!/usr/bin/env bash
# Runs in the terminal of an editor that attaches: starts JupyterLab as `make chapters` does, in the student's folder
# `my_course` and with its first chapter open, and with live views behind its port.
set -euo pipefail
cd "$(dirname "$0")/.."
options="--no-browser --ip=127.0.0.1 --port=8888"
if [ "${CODESPACES:-}" = true ]; then
    # GitHub lets only the owner of a codespace reach its ports, and asks for them under this name.
    options+=" --IdentityProvider.token= --ServerApp.allow_origin=https://$CODESPACE_NAME-8888.$GITHUB_CODESPACES_PORT_FORWARDING_DOMAIN"
fi
export COURSE_PROXY=/
exec make --no-print-directory chapters JUPYTER_OPTIONS="$options $*"
