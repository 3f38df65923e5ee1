#!/usr/bin/env bash
# Runs in the terminal of an editor that attaches: starts JupyterLab, with live views behind its port.
set -euo pipefail
cd "$(dirname "$0")/.."
options=(--no-browser --ip=127.0.0.1 --port=8888 --ServerApp.root_dir="$PWD")
if [ "${CODESPACES:-}" = true ]; then
    # GitHub lets only the owner of a codespace reach its ports, and asks for them under this name.
    options+=(--IdentityProvider.token= --ServerApp.allow_origin="https://$CODESPACE_NAME-8888.$GITHUB_CODESPACES_PORT_FORWARDING_DOMAIN")
fi
export COURSE_PROXY=/ PATH="$PWD/.venv/bin:$PATH"
exec .venv/bin/jupyter lab "${options[@]}" "$@"
