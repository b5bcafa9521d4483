# The program alone, linked statically: docker run --rm -v "$PWD:/models" mbint run model.yaml
#
# The folder of the build has the program of each architecture, as AMD64/mbint and ARM64/mbint in small letters.
FROM scratch
ARG TARGETARCH
COPY ${TARGETARCH}/mbint /usr/bin/mbint
# Where files are made that appear when they are whole.
WORKDIR /models
ENTRYPOINT ["/usr/bin/mbint"]
