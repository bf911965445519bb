# What CI checks, and the rest that wants a tool of its own.

# Everything that must hold before a change lands.
check:
    .ci/run

# The tests alone.
test:
    cargo test

# The properties on cases that no run has tried yet; what fails is printed, and kept in a folder proptest-regressions.
explore times="20":
    for i in $(seq {{times}}); do PROPTEST_RNG_SEED=$(date +%s%N) cargo test --quiet || exit 1; done

# Rays per second of each method, and where the time goes.
bench:
    cargo bench

# Licences, sources and duplicates of the dependencies (wants cargo-deny).
deny:
    cargo deny check

# The README's pictures of an editor at work (wants Node.js and Chromium).
shots:
    cargo build --release
    npm --prefix grammar/editors/shots ci
    PINHOLE="$PWD/target/release/pinhole" npm --prefix grammar/editors/shots run shoot
