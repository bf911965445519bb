# The checks of CI, and tasks that need further tools.

# Runs everything that must pass before a change lands.
check:
    .ci/run

# Runs only the tests.
test:
    cargo test

# Tests the properties on new cases; failing ones are kept in a folder proptest-regressions.
explore times="20":
    for i in $(seq {{times}}); do PROPTEST_RNG_SEED=$(date +%s%N) cargo test --quiet || exit 1; done

# Measures the rays per second of each method, and where the time goes.
bench:
    cargo bench

# Checks licences, sources and duplicates of the dependencies (needs cargo-deny).
deny:
    cargo deny check

# Makes the README's pictures of an editor at work (needs Node.js and Chromium).
shots:
    cargo build --release
    npm --prefix grammar/editors/shots ci
    PINHOLE="$PWD/target/release/pinhole" npm --prefix grammar/editors/shots run shoot
