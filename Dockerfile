# SPDX-License-Identifier: Apache-2.0
# The packages of `make deb` in Debian 12 (docs/packages.md):
#   docker build --file Dockerfile --tag stillmap build/release/packages
FROM debian:12-slim

RUN --mount=type=bind,target=/packages \
    apt-get update && \
    apt-get install --yes --no-install-recommends /packages/stillmap_*.deb /packages/python3-stillmap_*.deb && \
    rm -rf /var/lib/apt/lists/* && \
    useradd --create-home --uid 1000 stillmap

USER stillmap
WORKDIR /data
ENTRYPOINT ["stillmap"]
