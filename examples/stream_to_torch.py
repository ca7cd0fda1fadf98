"""How do I train on gearboxes that no disk has to hold? Windows are simulated while the network learns."""

import sys
from itertools import islice

import matplotlib.pyplot as plt
import torch
from torch.utils.data import DataLoader

import siggen
from diagnostics.loader import StreamedWindows

torch.manual_seed(0)
spall = {"kind": "irregular", "gear": "pinion", "teeth": 1, "profile_length_mm": 1.5, "face_share": 1.0}
states = {"others": None, "healthy": {}, "spalled": {"damage": spall}}
design = siggen.load_config({"extends": "quickstart", "name": "stream", "duration_s": 0.5, "states": states})
stream = siggen.stream(design, mixed=2, executor="serial")  # leave executor out: one process for each core
loader = DataLoader(StreamedWindows(stream, reuse=80), batch_size=16)
network = torch.nn.Sequential(
    torch.nn.Conv1d(2, 16, 64, stride=8), torch.nn.ReLU(), torch.nn.AdaptiveMaxPool1d(1), torch.nn.Flatten(),
    torch.nn.Linear(16, 1),
)  # fmt: skip
optimiser, losses = torch.optim.AdamW(network.parameters(), 3e-3), []
for windows, damaged in islice(loader, 40):
    said = network(windows / windows.std())[:, 0]
    loss = torch.nn.functional.binary_cross_entropy_with_logits(said, damaged.float())
    optimiser.zero_grad()
    loss.backward()
    optimiser.step()
    losses.append(loss.item())

figure, axes = plt.subplots(layout="constrained")
axes.plot(losses)
axes.axhline(0.693, color="grey", ls="--", label="guessing")
axes.set(xlabel="step of 16 windows", ylabel="loss on windows that it learns from")
axes.legend()
figure.savefig(sys.argv[1]) if len(sys.argv) > 1 else plt.show()
