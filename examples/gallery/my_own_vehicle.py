# %% [markdown]
# # My own vehicle
#
# Two sections, a sensor, a gimbaled thrust that pulsates: is it safe where it operates, what is the
# nearest danger, and what would help?
#
# The cells run from top to bottom in any editor that knows `# %%`, or as a script; behind `# `
# stands what is printed.

# %% [markdown]
# ## The vehicle
#
# Stations count from the nose, in metres, kilograms, seconds and newtons. The same could stand in a
# file, for `verify vehicle mine.toml`; docs/vehicles.md has every key.

# %%
from hill import Damping, Section, Sensor, Thrust, Vehicle

stages = (
    Section(length=12.0, mass_per_length=900.0, EI=2.0e8, name="upper"),
    Section(length=18.0, mass_per_length=1500.0, EI=6.0e8, name="lower"),
)
vehicle = Vehicle(
    sections=stages,
    thrust=Thrust(mean=4.0e5),
    sensors=(Sensor(station=15.0, K_theta=0.5),),
    damping=Damping(eta=0.05),
    modes=2,
)
print(vehicle.length)  # 30.0

# %% [markdown]
# ## Its frequencies
#
# Without thrust, in hertz, from its exact modes; and under the steady thrust, in radians a second,
# the rotation first.

# %%
print(vehicle.frequencies().round(2))  # [2.25 6.08]
low, *bending = vehicle.natural_frequencies().real
print(low < min(bending))  # True

# %% [markdown]
# ## One forcing, both routes
#
# Hill's determinant on the exact modes, and the time domain on finite elements: different matrices,
# the same answer. Here at the sum of the two lowest frequencies.

# %%
from compare import crosscheck

Omega = float(low + bending[0])
x = crosscheck(vehicle, Omega=Omega, gamma=0.3)
print(x.verdict, x.routes_agree, x.shared_matrices)  # unstable True False
x

# %% [markdown]
# ## What would help
#
# T is twice the growth exponent, and damping takes away as much of it as it has itself. Or else a
# number of the vehicle's own: ten per cent less of each. Stiffness and mass move the resonance away
# from where the thrust pulsates, rather than weaken it.

# %%
from hill.system import parameter_values, varied

for name, value in parameter_values(vehicle).items():
    if value:
        less = crosscheck(varied(vehicle, {name: 0.9 * value}), Omega=Omega, gamma=0.3)
        print(f"{name:>16}: T from {x.T:.5f} to {less.T:.5f}, {less.verdict}")

damped = crosscheck(vehicle, Omega=Omega, gamma=0.3, eta=x.T + 0.01)
print(damped.verdict)  # stable

# %% [markdown]
# ## Where it is unstable
#
# Over the frequency and the ratio of the pulsation.

# %%
from compare import chart, instabilities

axes = [("Omega", 0.8 * Omega, 1.2 * Omega, 160), ("gamma", 0.0, 0.6, 80)]
c = chart(vehicle, axes)
print([i.resonance.name for i in instabilities(c, orders=1)])  # ['omega_(1) + omega_(B)']
c

# %% [markdown]
# ## How it moves
#
# Let go and followed for fifty periods; every value has a bound.

# %%
from floquet import simulate

s = simulate(vehicle.equation(Omega=Omega, gamma=0.3), q0=[1.0, 1.0, 1.0], v0=[0.0, 0.0, 0.0])
print(s.q.shape, s.error.max() < 1e-6 * abs(s.q).max())  # (2001, 3) True

# %% [markdown]
# Everything that can be asked about a vehicle at once: `verify vehicle mine.toml`, and as pages,
# `verify report mine.toml --output pages`.
